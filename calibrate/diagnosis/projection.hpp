// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What the baseline parameters cannot absorb: whitened residual and fingerprints, projected.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tilth {

/// One number that a test gives. All statistics are in log units or divided by a typical value.
struct Statistic {
  std::string experiment;  ///< the rig: "direct_shear"; one rig's artefact moves no other rig
  std::string name;        ///< "direct_shear.peak_10kPa"
};

/// The simulator near the fitted parameters theta, in p statistics, q parameters, K effects.
struct LinearModel {
  std::vector<Statistic> statistics;  ///< (p)
  Eigen::MatrixXd jacobian;           ///< (p, q) d eta / d theta
  Eigen::VectorXd prior_precision;    ///< (q) of theta, 0 = no prior; or empty: none at all
  Eigen::VectorXd prior_offset;       ///< (q) prior mean - theta; empty with the above
  /// (p, K) [eta(theta, h_k) - eta(theta, 0)] / h_k: finite secants on common packings.
  Eigen::MatrixXd fingerprints;
  Eigen::MatrixXd fingerprint_variances;  ///< (p, K) of their own packing noise; empty: none
  Eigen::MatrixXd jacobian_variances;     ///< (p, q) the same of the jacobian; empty: none
};

/// Rows of L^-1, V = L L', then one row per parameter that has a prior.
struct WhitenedEvidence {
  Eigen::VectorXd residual;      ///< (num_rows)
  Eigen::MatrixXd jacobian;      ///< (num_rows, q)
  Eigen::MatrixXd fingerprints;  ///< (num_rows, K)
  Eigen::MatrixXd root;          ///< (p, p) L
};

/// @throws std::invalid_argument if shapes disagree, a number is not finite, or the covariance is
/// not
///         positive definite
WhitenedEvidence whitened(const LinearModel& model, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& covariance);

/// The part of residual and fingerprints that no change of theta can imitate.
///
/// With V = L L', r_w = L^-1 r, J_w = L^-1 J, s_k = L^-1 fingerprint_k, and the prior of theta as
/// further observations (rows sqrt(P_j) e_j, residual sqrt(P_j) prior_offset_j, fingerprint 0),
///
///   M = I - J_w (J_w' J_w)^+ J_w' = B B',   u = B' r_w,   t_k = M s_k = B f_k,   f_k = B' s_k.
///
/// u ~ N(alpha_k f_k, I) if effect k of size alpha_k is all that is missing.
/// @source Rao 1948; appended priors: docs/theory/diagnosis.md
struct ProjectedEvidence {
  Eigen::MatrixXd basis;         ///< (num_rows, nu) B, orthonormal; rows: statistics, then priors
  Eigen::VectorXd u;             ///< (nu)
  Eigen::MatrixXd fingerprints;  ///< (nu, K) f_k, per unit of the effect
  Eigen::VectorXd kept;  ///< (K) |t_k|^2 / |s_k|^2: share a refit cannot imitate; 0 if s_k = 0
  /// (K) expected |t|^2 of packing noise alone: of the fingerprint itself, and of the jacobian
  /// times the change of parameters that imitates the fingerprint.
  Eigen::VectorXd noise_norms;
  std::vector<std::string> experiments;  ///< (num_rows) rig of every row, "" for priors

  Eigen::Index nu() const { return u.size(); }
  /// |t_k|^2 at least 4 times its own noise, and not zero: may be named.
  bool is_measurable(Eigen::Index effect) const;
};

/// Null directions of the jacobian cost nothing: nu = num_rows - rank; 0 where the parameters can
/// follow any data.
/// @throws std::invalid_argument as whitened()
ProjectedEvidence project(const LinearModel& model, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& covariance);

/// The same for some of the statistics: rows of model, residual and covariance that are kept.
struct EvidenceRows {
  LinearModel model;
  Eigen::VectorXd residual;
  Eigen::MatrixXd covariance;
};
EvidenceRows selected_rows(const LinearModel& model, const Eigen::VectorXd& residual,
                           const Eigen::MatrixXd& covariance,
                           const std::vector<Eigen::Index>& statistics);

/// Rows of one experiment, or (complement) of all others, in ascending order.
std::vector<Eigen::Index> rows_of(const LinearModel& model, const std::string& experiment,
                                  bool complement = false);

/// Names of the experiments in order of first appearance.
std::vector<std::string> experiments_of(const LinearModel& model);

}  // namespace tilth
