// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Private to run_sensitivity(): the runs, and what becomes of one feature.
#pragma once

#include <vector>

#include "calibrate/sample_rows.hpp"
#include "calibrate/sensitivity.hpp"

namespace tilth {

/// What was run, in order of the rows.
struct StudyRuns {
  std::vector<SampleRow> rows;      ///< finished ones only
  std::vector<RowOutputs> outputs;  ///< one per target, T
  std::vector<SampleRun> runs;
  SensitivityEnd end = SensitivityEnd::completed;
};

// sensitivity_runs.cpp
StudyRuns run_rows(const std::vector<Parameter>& parameters, const std::vector<Target>& targets,
                   const Simulator& simulator, const SensitivityOptions& options);

// sensitivity_features.cpp
/// Indices, noise, failures and bounds of one feature by Morris or Sobol rows.
void analyse_rows(const std::vector<SampleRow>& rows, const RowOutputs& outputs,
                  const SensitivityOptions& options, FeatureSensitivity& feature);
/// The same from an emulator of single points; no bounds, since it fills the gaps itself.
void analyse_emulator(const std::vector<SampleRow>& rows, const RowOutputs& outputs,
                      const SensitivityOptions& options, FeatureSensitivity& feature);

}  // namespace tilth
