// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Two end plates and what the axial tests of cylinders share.
#pragma once

#include "experiments/lane_run.hpp"

namespace tilth {

enum PlatenId : int { bottom_platen, top_platen };

/// Planes at z = 0 and z = height that face each other; their numbers are those of PlatenId.
std::vector<Wall> platens(double height_m);

/// Lets the platens close at closing_speed / 2 each (open where it is negative), with the grains in
/// the velocity field of uniform axial straining, v (1/2 - z / H), so that no shock runs through
/// the specimen.
void start_straining(LaneRun& run, double height_m, std::span<const double> closing_speed_m_per_s);

/// Mean of both platen forces over the last interval, compression positive [N].
double axial_force_N(const LaneRun& run, int lane);

/// A cylinder strained at constant speed until it has failed.
struct AxialLoading {
  double radius_m = 0.0;
  double height_m = 0.0;
  double sense = 1.0;  ///< 1 compresses, -1 pulls; stress and strain are positive in this sense
  std::vector<double> speed_m_per_s = {};  ///< of both platens together, per lane, > 0
  double max_axial_strain = 0.0;
  double stop_at_peak_share = 0.0;
};

/// Steps until the stress has fallen below stop_at_peak_share of its peak at 1.15 times the peak's
/// strain ("past the peak"), or max_axial_strain ("at the strain limit"). Every 20 steps a row for
/// the first curve of each result: axial strain v t / H at the interval's middle, stress
/// = mean platen force of the interval / (pi R^2), bonds broken.
void run_past_peak(LaneRun& run, const AxialLoading& loading, const RunOptions& options);

/// A cylinder's packing; every test's packing_spec() names its own fields.
PackingSpec cylinder_packing(double radius_m, double height_m, int num_particles, double porosity,
                             double size_spread, std::uint64_t seed);

/// (speed / height) x mean diameter x sqrt(density / stress).
double axial_inertial_number(double speed_m_per_s, double height_m, double mean_radius_m,
                             double density_kg_per_m3, double stress_Pa);

}  // namespace tilth
