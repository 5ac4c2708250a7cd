// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a virtual test gives for one member of a batch.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tilth {

enum class RunStatus {
  completed,    ///< all stages reached their end, all numbers finite
  diverged,     ///< a grain moved more than a quarter radius in one step, or numbers left the reals
  not_settled,  ///< a stage did not reach its state within its step limit
  stopped,      ///< asked to stop from outside
  lost          ///< its process crashed or hung each time it was tried; set by who started it
};

/// "completed", "diverged", ...
const char* name_of(RunStatus status);

/// Columns of equal length; every name carries its unit.
struct Curve {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

struct Feature {
  std::string name;
  double value = 0.0;
};

struct ExperimentResult {
  RunStatus status = RunStatus::stopped;
  std::string message = "the test was not run";
  std::vector<Curve> curves;
  std::vector<Feature> features;  ///< empty unless completed
  double dt_s = 0.0;
  std::int64_t num_steps = 0;
  double inertial_number = 0.0;  ///< strain rate x mean diameter x sqrt(density / pressure) at peak

  /// Value of a feature; NaN if there is none of that name.
  double feature(const std::string& feature_name) const;
};

/// Curve as CSV text with a header line.
std::string curve_csv(const Curve& curve);

}  // namespace tilth
