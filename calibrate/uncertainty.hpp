// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Linear uncertainty of a least-squares fit, with what the data do not fix.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "calibrate/parameters.hpp"

namespace tilth {

/// A parameter with more than this share in null directions gets no error bar.
inline constexpr double max_null_share = 0.05;

/// In the unit cube of the free parameters.
struct LinearUncertainty {
  Eigen::MatrixXd covariance;  ///< (q, q), of the directions that are fixed by the data
  Eigen::MatrixXd null_space;  ///< (q, num_null), orthonormal columns: the other directions
  Eigen::VectorXd null_share;  ///< (q), sum of squares of a parameter's row of null_space
  /// May parameter j have an error bar? Its share in null directions is small, and a walk of length 1
  /// along them moves it by less than its standard error, which knows nothing of them.
  bool is_fixed(Eigen::Index j) const;
  Eigen::MatrixXd gain;        ///< (q, num_residuals), parameters moved by residuals: C = G W G'
  /// (q), error bar over the one that takes the noise of the derivatives for signal: 1 or more
  Eigen::VectorXd noise_factor;
  Eigen::Index num_drowned = 0;  ///< null directions whose derivatives noise alone explains
};

/// sqrt(diag(J C J')): standard deviation of predictions due to the parameters; NaN rows stay NaN.
/// @shape jacobian (num_predictions, q) in the coordinates of the covariance (q, q)
Eigen::VectorXd propagated_deviation(const Eigen::MatrixXd& jacobian,
                                     const Eigen::MatrixXd& covariance);

/// Covariance of the least-squares estimate from the Jacobian at the optimum.
///
///   J = U S V',   C = V_k S_k^-1 (U_k' W U_k) S_k^-1 V_k',   W = covariance of the residuals
///
/// over the kept singular values. With W = I this is (J'J)^-1; W differs from I where one packing
/// moves several features together. Nothing is rescaled by chi-square: sigma is absolute.
///
/// Noise of the derivatives adds N to J'J on average and makes all of this too short. With it,
///   B = 1 - S_k^-1 V_k' N V_k S_k^-1 = Q b Q',   gain = V_k S_k^-1 Q b^-1 Q' U_k',   C = gain W gain'
/// b_i is the share of the signal in what is known of a direction, taken as 1/3 if it is less. For W = I,
/// C = A^-1 (A + N) A^-1 with A = J'J - N: the fit ends where its noisy J is normal to the residuals, while
/// the true one moves them.
///
/// A direction is null if
///   s_i < 1.96           its 95 % half-width is longer than the whole unit cube, or
///   s_i < limit max(s)   it drowns in the error of the derivatives; 1e-3 suits the O(h^2) error of
///                        secants with steps of 5 %, or
///   b_i <= 0             noise alone explains the derivatives along it.
/// @shape jacobian (num_residuals, q), residuals divided by sigma_total, unit coordinates;
///        residual_covariance (num_residuals, num_residuals), unit diagonal; noise N (q, q), empty: there is none
/// @source Golub & Van Loan 2013, section 5.5; sandwich form Huber 1967; noise in the derivatives
///         as in errors-in-variables regression, Fuller 1987, section 2.2
LinearUncertainty linear_uncertainty(const Eigen::MatrixXd& jacobian,
                                     const Eigen::MatrixXd& residual_covariance,
                                     double relative_limit = 1e-3,
                                     const Eigen::MatrixXd& noise = {});

/// A direction in words: the combination of parameters that changes along it.
///
/// On log scales a direction (e_a, e_b) in ln a, ln b moves a^e_a b^e_b: "a x b" or "a / b", exponents relative to the largest. With linear parameters among them it is
/// a sum in units of the ranges: "a + 0.5 b". Shares below a tenth of the largest are
/// left out.
/// @shape direction (num_free), unit coordinates
std::string describe_direction(std::span<const Parameter> parameters,
                               const Eigen::VectorXd& direction);

/// "the data do not fix " and the direction.
std::string describe_null_direction(std::span<const Parameter> parameters,
                                    const Eigen::VectorXd& direction);

}  // namespace tilth
