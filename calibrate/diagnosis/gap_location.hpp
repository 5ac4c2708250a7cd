// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Where is the gap? Three views: single statistics, whole experiments, experiments against each
// other.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibrate/diagnosis/projection.hpp"

namespace tilth {

/// Residuals left by the best baseline, each divided by its own standard deviation.
///
///   (r - J dtheta)_i / sqrt(V_ii - (J Sigma J')_ii),  Sigma = (J' V^-1 J + P)^-1
///
/// N(0, 1) if nothing is missing. NaN where the baseline is forced through a statistic, so that it
/// could not have failed there (less than 1e-9 of V_ii left).
/// @shape (p)
/// @source Cook & Weisberg, Residuals and Influence in Regression, 1982, section 2.2
Eigen::VectorXd standardised_residuals(const LinearModel& model, const Eigen::VectorXd& residual,
                                       const Eigen::MatrixXd& covariance);

/// How well an experiment is predicted by a baseline fitted to all others.
struct LeftOutExperiment {
  std::string experiment;
  double statistic = 0.0;  ///< T_e, chi-square with `freedom` if nothing is missing
  double freedom = 0.0;    ///< 0: the others do not fix what this experiment depends on
  double tail_probability = 1.0;
};

/// T_e = d_e' (V_e + J_e Sigma_(-e) J_e')^-1 d_e for every experiment, d_e its prediction error.
///
/// Computed as the chi-square of all experiments minus that of the others, which is the same where
/// the others fix theta and stays right where they do not (test). Sharper than joint residuals:
/// what is missing spreads over all of them.
std::vector<LeftOutExperiment> left_out_experiments(const LinearModel& model,
                                                    const Eigen::VectorXd& residual,
                                                    const Eigen::MatrixXd& covariance);

/// Two experiments that want different parameters.
struct TugOfWar {
  std::string first, second;
  /// Q = (theta_a - theta_b)' (Sigma_a + Sigma_b)^-1 (theta_a - theta_b), each fitted alone
  double statistic = 0.0;
  double freedom = 0.0;  ///< number of parameter combinations that both experiments fix
  double tail_probability = 1.0;
};

/// All pairs of experiments, without priors. Computed from chi-squares, joint minus separate, which
/// needs no covariance of parameters that one experiment alone does not fix.
std::vector<TugOfWar> tugs_of_war(const LinearModel& model, const Eigen::VectorXd& residual,
                                  const Eigen::MatrixXd& covariance);

/// The change of one parameter that one experiment asks for while all others stay at the joint fit.
struct ParameterWish {
  std::string experiment;
  Eigen::Index parameter = 0;
  double change = 0.0;          ///< from the joint fit, in the unit of theta
  double standard_error = 0.0;  ///< infinite where the experiment does not depend on the parameter
};

std::vector<ParameterWish> parameter_wishes(const LinearModel& model,
                                            const Eigen::VectorXd& residual,
                                            const Eigen::MatrixXd& covariance);

}  // namespace tilth
