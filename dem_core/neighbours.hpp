// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Cell grid and Verlet list: which pairs, wall contacts and tool contacts the force loops visit.
#pragma once

#include "dem_core/state.hpp"

namespace tilth {

/// Gap below which pairs are listed: motion to come, and what attraction reaches.
inline double list_margin_m(const Workspace& workspace) {
  return workspace.skin_m + workspace.attraction_reach_m;
}

/// Lists every pair closer than its reference distance plus list_margin_m in at least one active lane,
/// every bond, and every grain that near to a wall or a feature of a tool; keeps contact memory of pairs that stay.
/// The list only has to be long enough: pairs out of reach add exactly nothing.
/// @cost O(num_particles x num_lanes)
void rebuild_neighbours(const Model& model, State& state, Workspace& workspace);

/// Pairs (i < j) with |x_i - x_j| < r_i + r_j + gap in one lane, sorted.
std::vector<ReferenceDistance> pairs_within(const Model& model, const State& state, double gap_m,
                                            int lane = 0);

}  // namespace tilth
