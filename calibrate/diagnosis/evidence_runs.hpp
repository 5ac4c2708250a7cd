// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Simulates what the statistics of the diagnosis need: packings at the fitted point, derivatives, fingerprints.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibrate/evaluator.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// One candidate effect switched on: columns of the parameters and the physical values they take.
struct EffectStep {
  std::vector<std::pair<Eigen::Index, double>> settings;  ///< the first is the effect's size, others where it acts
  double null_value = 0.0;  ///< of the first
  bool is_active = true;    ///< false: no test of the campaign depends on it; nothing is simulated
  bool is_costly = false;   ///< another specimen: alone in its pack, so on the first costly_packings only
  double step() const { return settings.front().second - null_value; }
};

/// Seeds and steps of the runs. Three blocks of packings that share none with each other or with a fit.
struct EvidencePlan {
  std::vector<std::uint64_t> residual_seeds;    ///< at the fitted point
  std::vector<std::uint64_t> derivative_seeds;  ///< secants and fingerprints, paired
  std::size_t costly_packings = 3;
  double log_step = 0.3;      ///< half-width of secants in ln v
  double linear_step = 0.1;   ///< else, as a share of upper - lower
};

/// Over all targets; NaN where no packing gave the number, and in derivatives where none was asked for.
struct SimulatedEvidence {
  Eigen::MatrixXd packings;              ///< (S, p) T at the point, packings that lack any of it left out
  Eigen::MatrixXd jacobian;              ///< (p, num_free) d T / d unit coordinate, mean over packings
  Eigen::MatrixXd jacobian_variances;    ///< (p, num_free) of these means
  Eigen::MatrixXd fingerprints;          ///< (p, K) [T(effect) - T(null)] / step, mean over packings
  Eigen::MatrixXd fingerprint_variances; ///< (p, K)
  std::vector<std::string> not_simulated;///< (K) why an effect has no fingerprint, or ""
  /// (p) of the mean over packings beside their scatter, as an emulator has it; empty: none.
  Eigen::VectorXd additional_variances = {};
};

/// Simulates the plan at one point of the unit cube of the free parameters.
///
/// Derivatives and fingerprints are taken packing by packing against the same packing at the point, so that
/// differences between packings cancel; their scatter over packings is their variance. An effect needs two packings in which
/// all numbers it is compared in exist; what a failed run lacks is left out, never replaced.
/// @param at_point  gives all targets at the point, with MissingFeatures::keep
/// @param around    gives the targets that are compared; may be the same
/// @param compared  targets of which derivatives and fingerprints are wanted: held-out ones need none
/// @return empty if the point itself gave fewer than two packings, or a stop or budget ended the runs
/// @cost S + D (1 + 2 num_free + active effects) simulations for S residual and D derivative seeds
std::optional<SimulatedEvidence> simulate_evidence(Evaluator& at_point, Evaluator& around,
                                                   const std::vector<Eigen::Index>& compared,
                                                   const std::vector<Parameter>& parameters,
                                                   const std::vector<Target>& targets,
                                                   const Eigen::VectorXd& unit,
                                                   const std::vector<EffectStep>& effects,
                                                   const EvidencePlan& plan);

/// T of all targets of a completed run; NaN for a failed one and for what it lacks.
Eigen::VectorXd transformed_features(const std::vector<Target>& targets, const Evaluation& run);

}  // namespace tilth
