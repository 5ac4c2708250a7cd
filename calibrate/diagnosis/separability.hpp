// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Can two effects be told apart by these data, and which further experiment would do it?
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "calibrate/diagnosis/effect_scores.hpp"

namespace tilth {

/// P(|z_i| > |z_j|) if effect i is true with noncentrality lambda = alpha^2 |t_i|^2 and the
/// projected fingerprints have correlation rho.
///
///   Phi(a) Phi(b) + (1 - Phi(a)) (1 - Phi(b)),
///   a = sqrt(lambda (1 - rho) / 2),  b = sqrt(lambda (1 + rho) / 2)
///
/// Exact: z_i - z_j and z_i + z_j are independent.
/// @pre lambda >= 0, |rho| <= 1
/// @source own derivation, docs/theory/diagnosis.md
double ordering_probability(double lambda, double rho);

/// rho_ij = t_i' t_j / (|t_i| |t_j|), unit diagonal; 0 beside effects that are not measurable.
/// @shape (K, K)
Eigen::MatrixXd look_alike_map(const ProjectedEvidence& evidence);

/// lambda_k = size_k^2 |t_k|^2.  @shape sizes (K)
Eigen::VectorXd noncentralities(const ProjectedEvidence& evidence, const Eigen::VectorXd& sizes);

/// Can i, true with lambda_i, be told from j in 95 % of cases: lambda_i (1 - |rho_ij|) >= 5.4?
/// Ten times the replicates are needed at |rho| = 0.95 for what 0.5 gives: another experiment
/// serves better.
bool is_separable(double lambda, double rho);

/// Groups of effects that cannot be told apart: i and j are linked unless each, if true with its
/// lambda, is separable from the other. Linked effects form one group (connected components), each
/// in ascending order; groups in order of their first effect.
std::vector<std::vector<std::size_t>> look_alike_groups(const Eigen::MatrixXd& look_alikes,
                                                        const Eigen::VectorXd& lambda,
                                                        const std::vector<std::size_t>& effects);

/// An experiment that could be made: rows it would add to model and covariance.
struct PossibleExperiment {
  std::string name;
  LinearModel model;  ///< its statistics, with the parameters and effects of the present one
  Eigen::MatrixXd covariance;  ///< (p_new, p_new), at the planned number of replicates
  double cost = 1.0;           ///< > 0, any unit
};

/// What it would do for the worst pair of contenders.
struct ExperimentAdvice {
  std::string name;
  double separation_before = 0.0;  ///< least lambda_i (1 - |rho_ij|) over ordered pairs
  double separation_after = 0.0;
  double ordering_before = 0.0;  ///< ordering_probability() of that pair
  double ordering_after = 0.0;
  double gain_per_cost = 0.0;  ///< (separation after - before) / cost
  /// The same for the mean over ordered pairs of min(5.4, separation): decides between experiments
  /// that leave the worst pair as it is.
  double mean_gain_per_cost = 0.0;
};

/// Ranks the possible experiments by the gain in the least separation of all pairs of contenders,
/// each true in turn at its size, per cost; best first. Ties, as where no single experiment shows
/// all contenders, go to the gain in the mean, then to the given order. Empty with fewer than two
/// contenders.
/// @param sizes  (K), in units of the effects: estimated or typical
/// @source T-optimal discrimination: Atkinson & Fedorov, Biometrika 62 (1975) 57
std::vector<ExperimentAdvice> next_experiments(const LinearModel& model,
                                               const Eigen::MatrixXd& covariance,
                                               const std::vector<std::size_t>& contenders,
                                               const Eigen::VectorXd& sizes,
                                               const std::vector<PossibleExperiment>& possible);

}  // namespace tilth
