// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/uncertainty.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace tilth {
namespace {

constexpr double least_signal_share = 1.0 / 3.0;  // the correction trebles an error bar at most
constexpr double normal_95 = 1.959963984540054;

// "a", "a^0.5": one factor of a product; the sign is said by "x" or "/".
std::string factor(const std::string& name, double exponent) {
  const double size = std::abs(exponent);
  return std::abs(size - 1.0) < 0.05 ? name : fmt::format("{}^{:.2g}", name, size);
}

// "a", "0.5 a": one term of a sum.
std::string term(const std::string& name, double coefficient) {
  const double size = std::abs(coefficient);
  return std::abs(size - 1.0) < 0.05 ? name : fmt::format("{:.2g} {}", size, name);
}

// Directions of the data in which the derivatives are signal, and those that drown in their noise.
struct SignalShares {
  Eigen::MatrixXd kept;     // orthonormal columns, in the coordinates of the kept singular values
  Eigen::VectorXd shares;   // of the signal, one per column of kept
  Eigen::MatrixXd drowned;  // the other columns
};

SignalShares signal_shares(const Eigen::MatrixXd& scaled, const Eigen::MatrixXd& noise) {
  const Eigen::Index n = scaled.cols();
  if (n == 0 || noise.size() == 0) {
    return {Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Ones(n), Eigen::MatrixXd(n, 0)};
  }
  const Eigen::MatrixXd share = Eigen::MatrixXd::Identity(n, n) - scaled.transpose() * noise * scaled;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(share);
  const Eigen::Index num_drowned = (solver.eigenvalues().array() <= 0.0).count();  // smallest first
  return {solver.eigenvectors().rightCols(n - num_drowned),
          solver.eigenvalues().tail(n - num_drowned).cwiseMax(least_signal_share),
          solver.eigenvectors().leftCols(num_drowned)};
}

// An orthonormal basis of what the columns span. They are independent.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns.colwise().normalized());
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

}  // namespace

bool LinearUncertainty::is_fixed(Eigen::Index j) const {
  return null_share[j] <= max_null_share && null_share[j] <= covariance(j, j);
}

Eigen::VectorXd propagated_deviation(const Eigen::MatrixXd& jacobian,
                                     const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd half = jacobian * covariance;
  const Eigen::ArrayXd variance = half.cwiseProduct(jacobian).rowwise().sum().array();
  return (variance < 0.0).select(0.0, variance).sqrt();  // rounding of a zero
}

LinearUncertainty linear_uncertainty(const Eigen::MatrixXd& jacobian,
                                     const Eigen::MatrixXd& residual_covariance,
                                     double relative_limit, const Eigen::MatrixXd& noise) {
  const Eigen::Index q = jacobian.cols();
  // Rows of zeros make V square when there are fewer residuals than parameters.
  const Eigen::Index num_rows = std::max(jacobian.rows(), q);
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(num_rows, q);
  padded.topRows(jacobian.rows()) = jacobian;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(padded, Eigen::ComputeThinU | Eigen::ComputeThinV);

  const Eigen::VectorXd s = svd.singularValues();
  const double limit = std::max(normal_95, relative_limit * s[0]);
  const Eigen::Index num_kept = (s.array() >= limit).count();  // sorted, largest first
  const Eigen::MatrixXd u = svd.matrixU().topRows(jacobian.rows()).leftCols(num_kept);
  const Eigen::MatrixXd v = svd.matrixV().leftCols(num_kept);
  const Eigen::MatrixXd scaled = v * s.head(num_kept).cwiseInverse().asDiagonal();
  const SignalShares signal = signal_shares(scaled, noise);

  LinearUncertainty result;
  const Eigen::MatrixXd corrected =
      scaled * signal.kept * signal.shares.cwiseInverse().asDiagonal() * signal.kept.transpose();
  result.gain = corrected * u.transpose();
  result.covariance = result.gain * residual_covariance * result.gain.transpose();
  const Eigen::MatrixXd naive = scaled * signal.kept * signal.kept.transpose() * u.transpose();
  result.noise_factor = (result.covariance.diagonal().array() /
                         (naive * residual_covariance * naive.transpose()).diagonal().array())
                            .sqrt();
  result.num_drowned = signal.drowned.cols();
  result.null_space = svd.matrixV().rightCols(q - num_kept);
  if (signal.drowned.cols() > 0) {
    Eigen::MatrixXd null(q, q - num_kept + signal.drowned.cols());
    null << result.null_space, scaled * signal.drowned;
    result.null_space = orthonormal(null);
  }
  result.null_share = result.null_space.rowwise().squaredNorm();
  return result;
}

std::string describe_direction(std::span<const Parameter> parameters,
                               const Eigen::VectorXd& direction) {
  const std::vector<std::size_t> free = free_parameters(parameters);
  bool all_log = true;
  Eigen::VectorXd exponents = direction;
  for (std::size_t j = 0; j < free.size(); ++j) {
    const auto index = static_cast<Eigen::Index>(j);
    if (std::abs(direction[index]) < 0.1 * direction.cwiseAbs().maxCoeff()) exponents[index] = 0.0;
    if (exponents[index] != 0.0 && !parameters[free[j]].log_scale) all_log = false;
  }
  if (all_log) {
    for (std::size_t j = 0; j < free.size(); ++j) {
      exponents[static_cast<Eigen::Index>(j)] *= coordinate_span(parameters[free[j]]);
    }
  }
  Eigen::Index largest = 0;
  exponents.cwiseAbs().maxCoeff(&largest);
  exponents /= exponents[largest];  // the first word is never "1 /"

  std::string words = all_log
                          ? factor(parameters[free[static_cast<std::size_t>(largest)]].name, 1.0)
                          : term(parameters[free[static_cast<std::size_t>(largest)]].name, 1.0);
  for (std::size_t j = 0; j < free.size(); ++j) {
    const double e = exponents[static_cast<Eigen::Index>(j)];
    if (static_cast<Eigen::Index>(j) == largest || e == 0.0) continue;
    const std::string& name = parameters[free[j]].name;
    words += all_log ? fmt::format(" {} {}", e > 0.0 ? "x" : "/", factor(name, e))
                     : fmt::format(" {} {}", e > 0.0 ? "+" : "-", term(name, e));
  }
  return words + (all_log ? "" : " (each in units of its range between the bounds)");
}

std::string describe_null_direction(std::span<const Parameter> parameters,
                                    const Eigen::VectorXd& direction) {
  return "the data do not fix " + describe_direction(parameters, direction);
}

}  // namespace tilth
