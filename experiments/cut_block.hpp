// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A block cut at an angle from a larger packing.
#pragma once

#include <memory>

#include "dem_core/packing_store.hpp"

namespace tilth {

/// Grains of a block after the block has been turned by angle_rad about the y axis (right hand: z
/// towards x) and laid with its middle on that of the box: the deepest ones behind the box's faces in
/// x and z, until their volume reaches solid_m3 or none are left. Not relaxed, in the order of depth.
Packing cut_from(const Packing& block, const Vec3& block_size_m, const Vec3& box_size_m,
                 double solid_m3, double angle_rad);

/// Packing of the box `spec` whose grains lie as if they had been cut from a larger block turned by
/// angle_rad about y. Angle 0 is the packing of `spec` itself.
///
/// The block has the grain size and porosity of `spec`; it is wide enough for the box at any angle and
/// a margin of two mean radii in x and z, so that no wall layer of the block gets into the specimen,
/// and as long as the box along y. The box gets the deepest grains up to its own porosity, then its
/// walls push in what sticks out (relaxed_packing): the outermost one or two layers lie anew, the
/// grains behind them as in the block. The number of grains is that of `spec` on average only.
/// @pre spec.shape is a box
/// @cost the block has about 2.5 times the grains of the box
std::shared_ptr<const Packing> cut_block(PackingStore& packings, const PackingSpec& spec,
                                         double angle_rad);

}  // namespace tilth
