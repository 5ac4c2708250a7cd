// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// From the records of one sweep to curves and features.
#pragma once

#include "experiments/sweep_tillage.hpp"

namespace tilth {

/// What a lane of sweep_tillage leaves behind.
struct SweepRecord {
  double surface_m = 0.0;
  std::vector<Vec3> settled_m;  ///< before the tool came
  std::vector<Vec3> at_rest_m;  ///< after it has gone
  std::vector<Tracer> tracers;
};

/// The curve that the protocol fills while the tool moves; the first curve of a result.
Curve empty_force_curve();

/// Adds curves and features to a result whose first curve holds the forces.
void read_sweep(const SweepTillageConfig& config, const std::vector<double>& radius_m,
                const SweepRecord& record, ExperimentResult& result);

}  // namespace tilth
