// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// From a packing and a few materials to a Model and State whose lanes are those materials.
#pragma once

#include <span>

#include "dem_core/packing.hpp"
#include "dem_core/state.hpp"
#include "experiments/bond_strengths.hpp"
#include "experiments/material.hpp"

namespace tilth {

/// How grains become a specimen.
struct BondingSpec {
  /// Pairs with a gap below this share of the mean radius are bonded; < 0 bonds nothing.
  double max_gap_over_radius = 0.1;
  /// Numbers of the walls that hold every grain within that gap by glue, for good.
  std::vector<int> glued_walls = {};
  BondPlace place = {};
};

struct Specimen {
  Model model;
  State state;
  double mean_radius_m = 0.0;
};

/// Lanes = materials (1, 4 or 8 of them). The packing's overlaps carry no force: every touching pair
/// keeps its distance as reference, every bond its length as rest length, every wall contact its
/// distance, every tool contact likewise. Time steps: 0.8 of the stable bound of the lane, snapped down to the ladder.
Specimen make_specimen(const Packing& packing, std::span<const SoilMaterial> materials,
                       const std::vector<Wall>& walls, const BondingSpec& bonding,
                       const std::vector<Tool>& tools = {});

}  // namespace tilth
