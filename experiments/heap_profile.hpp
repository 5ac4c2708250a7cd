// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The surface of a heap in a slab, and the straight line through it.
#pragma once

#include <vector>

#include "experiments/specimen.hpp"

namespace tilth {

/// The slab 0 <= x <= length, 0 <= y <= thickness in which a heap stands with its back at x = 0.
struct HeapFrame {
  double length_m = 0.0;
  double thickness_m = 0.0;
  double floor_m = 0.0;  ///< z from which heights count
  double cell_m = 0.0;   ///< one mean diameter
};

/// Height of the surface over the middle of each cell along x: the largest height of a grain's top in every cell
/// of cell x cell, averaged over the slab's thickness. Fixed grains do not count; an empty cell has 0.
/// @return heights [m]; entry k belongs to x = (k + 1/2) cell
std::vector<double> heap_profile_m(const Specimen& specimen, int lane, const HeapFrame& frame);

struct HeapShape {
  double angle_rad = 0.0;   ///< slope of the least-squares line from 0.15 to 0.85 of the runout, falling
  double height_m = 0.0;    ///< mean of the profile's two cells at the back
  double runout_m = 0.0;    ///< where the profile first falls below 3/4 of a cell; the length if nowhere
  int num_points = 0;       ///< of the line; fewer than 3: there is no line, angle_rad is 0
};

/// The window leaves out the rounded crest at the back and the tail at the toe. Own choice.
HeapShape heap_shape(const std::vector<double>& profile_m, double cell_m);

}  // namespace tilth
