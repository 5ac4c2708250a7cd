// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A tillage sweep as one closed mesh: two wings that meet in a nose, and a shank.
#pragma once

#include <string>
#include <vector>

#include "dem_core/model.hpp"

namespace tilth {

/// A symmetric sweep that travels along +x. Both cutting edges lie in z = 0 and run from the nose at the
/// origin back to the wing tips; the wings' upper faces rise behind them.
struct SweepShape {
  double width_m = 0.25;          ///< from wing tip to wing tip
  double sweep_angle_rad = 1.2217304763960306;  ///< between the cutting edges, in (0, pi); 70 degrees
  double rake_angle_rad = 0.4363323129985824;   ///< upper face to the horizontal, across its edge; 25 degrees
  double wing_height_m = 0.03;    ///< of the trailing edges above the cutting edges
  double thickness_m = 0.006;     ///< of the wings, at right angles to their faces
  double shank_width_m = 0.03;    ///< across the travel
  double shank_length_m = 0.05;   ///< along the travel
};

/// Distance along the travel from a cutting edge to the trailing edge behind it:
///   D = h / (tan(rake) sin(sweep / 2))
double wing_depth_m(const SweepShape& shape);

/// From the nose back to the trailing corners of the wings: D + width / (2 tan(sweep / 2)).
double sweep_length_m(const SweepShape& shape);

/// Everything that keeps the shape from being a solid, one sentence each.
std::vector<std::string> problems(const SweepShape& shape);

/// The sweep with its shank up to `top_m`, nose at the origin, one closed outward mesh.
///
///   upper faces  z = tan(rake) (-x sin(sweep/2) - |y| cos(sweep/2)), from 0 to the wing height h
///   lower faces  z = max(0, upper - t / cos(rake)): the cutting edge is ground flat below
///   volume       width / sin(sweep/2) x A + w_s l_s x (top - mean height of the faces under the shank),
///                A = (h^2 - (h - t/cos(rake))^2) / (2 tan(rake))
/// The wings end in the planes |y| = width / 2 and, behind, in vertical faces. The shank's section is a
/// rectangle in the middle of the share, between the nose's flanks and the trailing edges.
/// @pre problems(shape) is empty and top_m > shape.wing_height_m
/// @source own construction; angles named as in Hanna et al. (docs/experiments/sweep_tillage.md)
Mesh sweep_mesh(const SweepShape& shape, double top_m);

}  // namespace tilth
