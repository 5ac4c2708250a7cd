// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Which parameters move which features: Morris and Sobol on any noisy, failing simulator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "calibrate/evaluator.hpp"
#include "calibrate/failure_pattern.hpp"
#include "calibrate/packing_noise.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/sensitivity_index.hpp"
#include "calibrate/simulator.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

enum class SensitivityMethod {
  morris,    ///< elementary effects: rows are trajectories of d + 1 runs
  sobol,     ///< Saltelli rows of 2 d + 2 runs
  emulator,  ///< Sobol indices of an emulator made of single points: rows are one run each
};

std::string_view to_string(SensitivityMethod method);

struct SensitivityOptions {
  SensitivityMethod method = SensitivityMethod::morris;
  int num_rows = 16;        ///< samples: trajectories, rows or points; see default_num_rows()
  int levels = 4;           ///< Morris grid: even, >= 4. Its numbers, and ranks, depend on it
  PackingPlan packings;     ///< first_seed seeds the design too
  int num_resamples = 500;  ///< bootstrap
  std::size_t max_simulations = std::numeric_limits<std::size_t>::max();
  std::function<bool()> should_stop;              ///< asked before every batch; may be empty
  std::function<void(const Progress&)> progress;  ///< called after every batch; may be empty
};

/// Rows where nothing else is asked: 16 Morris, 64 Sobol, 64 emulator; with `quick` 6, 16 and 24.
int default_num_rows(SensitivityMethod method, bool quick);
/// Fewer say nothing: 4 Morris, 8 Sobol, and what an emulator needs.
int min_num_rows(SensitivityMethod method, std::size_t num_free);
/// Most points an emulator is made of; its cost grows with their cube.
inline constexpr int max_emulator_rows = 256;

/// Everything wrong with the study, one sentence each; empty if it may be run.
std::vector<std::string> problems(const std::vector<Parameter>& parameters,
                                  const SensitivityOptions& options);

/// How well an emulator predicts runs it has not seen.
struct EmulatorError {
  double q2 = std::numeric_limits<double>::quiet_NaN();   ///< leave-one-out, 1 is perfect
  double rms = std::numeric_limits<double>::quiet_NaN();  ///< leave-one-out, scale of the feature
};

/// One feature. All numbers refer to T (calibrate/targets.hpp): ln(value) if log_transform.
struct FeatureSensitivity {
  std::string name;
  bool log_transform = false;
  bool holdout = false;
  std::vector<IndexEstimate> indices;
  NoiseSplit noise;
  double noise_low95 = std::numeric_limits<double>::quiet_NaN();  ///< of noise.noise_share
  double noise_high95 = std::numeric_limits<double>::quiet_NaN();
  double noise_floor = std::numeric_limits<double>::quiet_NaN();  ///< Morris: mu_star of no effect
  FailurePattern failures;
  EmulatorError emulator;  ///< method emulator only
  std::string no_indices;  ///< why there are none; empty if there are
};

/// One run, with everything needed to use it elsewhere.
struct SampleRun {
  std::size_t row = 0;
  std::size_t point = 0;   ///< column of its row
  bool is_repeat = false;  ///< on the row's second packing
  bool is_known = false;   ///< the same parameters on the same packing came earlier
  std::uint64_t seed = 0;
  Eigen::VectorXd parameters;  ///< physical, all
  Evaluation evaluation;

  bool has_failed() const;  ///< in one of its tests at least
};

enum class SensitivityEnd { completed, stopped, budget_spent };
std::string_view to_string(SensitivityEnd end);

struct SensitivitySummary {
  SensitivityOptions options;  ///< as asked
  SensitivityEnd end = SensitivityEnd::completed;
  int num_rows = 0;                          ///< rows that all runs were made of
  std::vector<std::string> free_names;       ///< in the order of IndexEstimate::parameter
  std::vector<FeatureSensitivity> features;  ///< in target order
  std::vector<SampleRun> runs;  ///< of the rows above, repeats after the points of a row
  std::size_t num_runs = 0;     ///< without is_known
  std::size_t num_failed = 0;   ///< of these, in one test at least

  bool has_indices() const;        ///< of one feature at least
  double widest_interval() const;  ///< of S and ST; NaN without
};

/// Runs one study.
///
/// A run may fail in one test and not in another (partial simulators): only the features of that
/// test are missing. Failed runs are left out, counted, and looked at for a pattern
/// (failure_pattern.hpp); where they have one, or are too few to show one, every estimate gets
/// bounds (missing_bounds.hpp). Rows are run in order, in batches; when a stop or the budget ends
/// it, the result is that of the rows finished until then, exactly as if num_rows had been that
/// number. Same arguments, same bits.
///
/// Hold-outs are features like the others here: nothing is fitted.
/// @pre problems(parameters, options) is empty
/// @throws what a simulator throws, and std::runtime_error if it breaks its contract
SensitivitySummary run_sensitivity(const std::vector<Parameter>& parameters,
                                   const std::vector<Target>& targets, const Simulator& simulator,
                                   const SensitivityOptions& options);

}  // namespace tilth
