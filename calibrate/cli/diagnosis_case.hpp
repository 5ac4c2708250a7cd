// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// One soil under diagnosis: its data, what was simulated, and the evidence that follows.
#pragma once

#include <string>
#include <vector>

#include "calibrate/cli/effect_choice.hpp"
#include "calibrate/diagnosis/effect_refit.hpp"
#include "calibrate/diagnosis/evidence_runs.hpp"
#include "calibrate/diagnosis/measured_campaign.hpp"
#include "calibrate/diagnosis/soil_evidence.hpp"

namespace tilth {

/// The disagreement of one experiment, relative, beyond noise.
struct ExperimentGap {
  std::string experiment;
  bool holdout = false;
  int num_statistics = 0;
  double gap = 0.0;
};

/// A model refitted to the same packings as every other one.
struct RefittedModel {
  std::vector<std::string> effects;  ///< ids; none: the baseline
  Refit refit;
  std::vector<ExperimentGap> gaps;   ///< experiments, fitted then held out, then all of each under the name ""
};

/// What changing a numerical setting does to the statistics, largest shift over its noise.
struct NumericalGate {
  std::string id;
  bool is_known = false;             ///< false: could not be simulated
  double largest_shift = 0.0;        ///< |shift| / sqrt(V_ii)
  std::string statistic;             ///< where
  bool passed() const { return is_known && largest_shift <= 0.5; }
};

/// Everything about one soil; filled stage by stage.
struct SoilCase {
  MeasuredCampaign campaign;         ///< means, effects among its parameters
  std::vector<Parameter> parameters;
  std::vector<Target> targets;
  std::vector<CandidateChoice> choices;
  std::vector<Eigen::Index> fitted;  ///< targets that are not held out

  Eigen::VectorXd unit;              ///< best baseline
  SimulatedEvidence simulated;       ///< all targets
  SoilEvidence evidence;             ///< fitted targets
  Eigen::MatrixXd covariance;        ///< (p, p) V of all targets
  std::vector<NumericalGate> gates;
  std::vector<RefittedModel> models; ///< the baseline first
  std::vector<std::string> remarks;
  std::string failure;               ///< why there is no evidence; empty if there is
};

/// Campaign, parameters and candidates of a soil. @throws ConfigError
SoilCase soil_case(const SoilData& soil);

/// (p) mean T of the specimens of every target.
Eigen::VectorXd measured_means(const SoilCase& soil);

/// (p, p) V of all targets: replicates and packings, moderated. @shape packings (S, p)
Eigen::MatrixXd noise_covariance_of(const SoilCase& soil, const Eigen::MatrixXd& packings);

/// What could not be compared (NaN) moves nothing: 0.
Eigen::MatrixXd finite_or_zero(const Eigen::MatrixXd& m);

/// Evidence of the fitted targets, V and gates from what was simulated at soil.unit. Parameters at their bounds are held there: they
/// absorb nothing, and a remark says so.
/// @pre simulated covers all targets and soil.choices
void set_evidence(SoilCase& soil, SimulatedEvidence simulated);

/// Disagreement of every experiment, fitted then held out, then all of each under the name "".
/// @shape residual (p) measured - simulated mean, all targets  @pre set_evidence()
std::vector<ExperimentGap> gaps_of(const SoilCase& soil, const Eigen::VectorXd& residual);

/// Every candidate switched on, in the order of soil.choices.
std::vector<EffectStep> steps_of(const SoilCase& soil);

/// Variance of one packing, pooled over the conditions of an observable. @shape packings (S, p), result (p)
Eigen::VectorXd pooled_packing_variances(const SoilData& soil, const Eigen::MatrixXd& packings);

/// Model near the optimum in the statistics `rows`; an effect without a whole fingerprint has a column of zeros.
LinearModel linear_model(const SoilData& soil, const SimulatedEvidence& e, const std::vector<Eigen::Index>& rows);

}  // namespace tilth
