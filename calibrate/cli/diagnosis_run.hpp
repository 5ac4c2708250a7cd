// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The simulations of a diagnosis: baseline fit, evidence, refits of the contenders, advice.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/diagnosis_case.hpp"
#include "calibrate/diagnosis/separability.hpp"
#include "calibrate/diagnosis/verdict.hpp"

namespace tilth {

struct DiagnosisSettings {
  Fidelity fidelity = Fidelity::search;
  std::uint64_t seed = 1;
  int num_starts = 12;              ///< parameter sets on one packing, of which the best starts the baseline's fit
  int num_baseline_passes = 3;      ///< each with new derivatives
  int num_residual_packings = 8;
  int num_derivative_packings = 8;
  int num_refit_packings = 6;
  int max_refit_steps = 4;
  int num_advice_packings = 3;
  DiagnosisOptions statistics;
};

/// A quick diagnosis uses preview specimens and fewer packings.
DiagnosisSettings diagnosis_settings(bool quick, std::uint64_t seed);

/// Runs of one case, for one soil after the other. All simulations go through one ledger.
class DiagnosisRunner {
 public:
  DiagnosisRunner(const DiagnosisSettings& settings, const RunContext& context, SimulationLedger& ledger);

  /// How many simulations a soil will take with two passes of the baseline and a verdict that calls for refits: for the progress line.
  std::size_t expected_simulations(const SoilCase& soil) const;
  /// Fits the baseline and simulates the evidence. The fit starts at `values` (of all parameters, physical), or at
  /// the best of a Sobol design within a fifth of the ranges about the nominal values; each pass takes secants on common packings and
  /// goes down by simulated Gauss-Newton steps. Sets of which a test fails lose that test's numbers only.
  void gather(SoilCase& soil, const std::optional<Eigen::VectorXd>& values) const;
  /// Refits baseline and contenders, each a list of candidates, on the same fresh packings.
  void refit_models(SoilCase& soil, const std::vector<std::vector<std::size_t>>& contenders) const;
  /// Which laboratory test that was not made would tell the contenders apart; best first.
  std::vector<ExperimentAdvice> advise(const SoilCase& soil, const std::vector<std::size_t>& contenders) const;

 private:
  std::vector<std::uint64_t> seeds(std::uint64_t block, int num) const;
  Evaluator evaluator_of(const SoilCase& soil, TargetScope scope) const;
  Eigen::VectorXd best_start(const SoilCase& soil, Evaluator& evaluator) const;
  void fit_baseline(SoilCase& soil, Evaluator& evaluator, Evaluator& around) const;
  const DiagnosisSettings& settings_;
  const RunContext& context_;
  SimulationLedger& ledger_;
};

}  // namespace tilth
