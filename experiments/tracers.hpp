// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Tracers: small cubes placed in a bed on a grid, followed as the aggregates that hold them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dem_core/model.hpp"

namespace tilth {

/// Where tracers lie: at every depth and lateral offset a row along the travel.
struct TracerGrid {
  std::vector<double> depth_m;    ///< below the surface
  std::vector<double> lateral_m;  ///< from the tool's path, to the left of the travel (+y)
  double spacing_m = 0.05;        ///< along the travel
  double size_m = 0.016;          ///< edge of the cube
};

/// One tracer: its place, and the aggregates that stand for it.
struct Tracer {
  double depth_m = 0.0;
  double lateral_m = 0.0;
  Vec3 site_m = Vec3::Zero();
  std::vector<int> particles;
};

/// Tracers of a grid over from_m <= x <= to_m, in the order depth, lateral, x. Aggregates whose centre is
/// in the cube stand for a tracer, or, where none is (aggregates larger than the tracer), the nearest.
/// An aggregate may stand for more than one tracer; `spacing_m` of a diameter and more avoids it.
std::vector<Tracer> place_tracers(const TracerGrid& grid, double from_m, double to_m,
                                  double surface_m, const std::vector<Vec3>& position_m);

/// Mean displacement of a tracer's aggregates: forward (+x), to the left (+y), up (+z). The turn of the
/// aggregate and the tracer's place in it are left aside.
Vec3 tracer_displacement_m(const Tracer& tracer, const std::vector<Vec3>& before_m,
                           const std::vector<Vec3>& after_m);

/// Mean over the row of tracers at one depth and offset.
struct TracerMean {
  double depth_m = 0.0;
  double lateral_m = 0.0;
  int num_tracers = 0;
  Vec3 mean_m = Vec3::Zero();
  Vec3 sd_m = Vec3::Zero();  ///< standard deviation of one tracer; 0 for a single one
};

/// One entry per depth and offset, in the order of the tracers.
std::vector<TracerMean> tracer_means(std::span<const Tracer> tracers,
                                     std::span<const Vec3> displacement_m);

/// "0.05m_-0.1m": depth and offset as they stand behind the @ of a feature.
std::string tracer_label(double depth_m, double lateral_m);

}  // namespace tilth
