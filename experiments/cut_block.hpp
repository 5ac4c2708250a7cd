// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A block cut at an angle from a larger packing.
#pragma once

#include <memory>

#include "dem_core/packing_store.hpp"

namespace tilth {

/// Packing of the box `spec` whose grains lie as if the box had been cut from a larger block after
/// turning the block by angle_rad about the y axis. Angle 0 is the packing of `spec` itself.
///
/// The block is made at the same grain size and porosity, long enough for the turned box and a margin
/// of two mean radii on every side in x and z, so that no wall layer of the block is in the specimen;
/// along y it is as long as the box. A grain is kept where its centre lies inside the box: cut faces
/// are true sections, through which grains stick out by less than their radius. The number of grains
/// is that of `spec` on average only.
/// @pre spec.shape is a box
std::shared_ptr<const Packing> cut_block(PackingStore& packings, const PackingSpec& spec,
                                         double angle_rad);

}  // namespace tilth
