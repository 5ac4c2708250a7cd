// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What is found: the product's decision on emulated evidence. The seeker's half of the scoreboard.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/diagnose/emulated_laboratory.hpp"
#include "calibrate/cli/diagnosis_decision.hpp"

namespace tilth::scoreboard {

/// A model fitted to the emulated laboratory: baseline, or with effects.
struct EmulatedFit {
  std::vector<std::size_t> effects;  ///< candidates whose sizes were fitted
  Eigen::VectorXd unit;
  Eigen::VectorXd sizes;
  double chi_square = 0.0;           ///< of the fitted targets
};

struct Finding {
  SoilCase soil;
  Diagnosis diagnosis;
  EmulatedFit baseline;
};

/// Least squares on the emulators, weighed by V: from the nominal values and a Sobol design.
EmulatedFit emulated_fit(const EmulatedLaboratory& laboratory, const SoilCase& soil, const Eigen::MatrixXd& covariance,
                         const std::vector<std::size_t>& effects);

/// Reads the data folder of a case and decides. Only `struck` is known of the hider: a candidate taken off the catalogue, or "".
Finding seek(const EmulatedLaboratory& laboratory, const std::filesystem::path& data, const std::string& struck,
             const DiagnosisOptions& options);

/// Gaps of models by real simulations, on packings no library and no twin has.
struct ProvenGap {
  double fitted = 0.0, held_out = 0.0;
  Eigen::VectorXd sizes;             ///< where it was simulated
};

/// One model of one finding, to be proven.
struct ProofJob {
  const Finding* finding = nullptr;
  EmulatedFit model;
};

/// Simulates all jobs at once, moves each by one Gauss-Newton step with the emulators' derivatives, simulates again and keeps the better of
/// the two by chi-square of the fitted targets. NaN gaps where nothing completed.
std::vector<ProvenGap> prove(const EmulatedLaboratory& laboratory, const std::vector<ProofJob>& jobs, Fidelity fidelity,
                             const RunContext& context);

}  // namespace tilth::scoreboard
