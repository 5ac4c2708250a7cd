// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Series of the scale study: one sweep test, run at several particle sizes on several packings.
#pragma once

#include <string>
#include <vector>

#include "calibrate/cli/test_runs.hpp"
#include "calibrate/scale_study.hpp"

namespace tilth {

/// What stays the same over the sizes.
struct ScaleSeries {
  std::string name;     ///< "loamy_sand", "loamy_sand narrow"
  std::string soil_id;
  SweepTillageConfig config;  ///< its radius is replaced
  SoilMaterial material;
};

/// Runs of one size.
struct ScaleSize {
  double radius_m = 0.0;
  int num_particles = 0;
  std::vector<ExperimentResult> runs;  ///< that completed
  std::vector<std::string> failures;   ///< "packing 3: not_settled: ..."
};

/// A series and what came out.
struct ScaleResult {
  ScaleSeries series;
  std::vector<ScaleSize> sizes;  ///< those with two packings and more that completed, finest first
  std::vector<ScaleSize> left_out;  ///< the others
  int num_sites = 0;             ///< depths and distances from the path whose tracers every run has
  std::string no_study;          ///< why there is none; empty if there is one
  ScaleStudy study;
  std::vector<Drift> draught, contact_density;
  /// Contacts per area of tool at the limit and at the ends of its interval (fewer at a larger radius), from the
  /// straight line through ln(density) over ln(radius); NaN where there is no such radius.
  double density_at_limit = 0.0, density_lo95 = 0.0, density_hi95 = 0.0;
};

/// The test of a series at one size.
SweepTillageConfig at_radius(const ScaleSeries& series, double radius_m, std::uint64_t packing_seed);

/// Runs every series at every size on packings first_seed, first_seed + 1, ...; the smallest radius first, since
/// it takes longest.
std::vector<ScaleResult> run_scale(const std::vector<ScaleSeries>& series,
                                   const std::vector<double>& radii_m, int num_packings,
                                   std::uint64_t first_seed, double tolerance, const RunContext& context);

}  // namespace tilth
