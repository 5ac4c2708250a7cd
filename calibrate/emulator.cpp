// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/emulator.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "calibrate/optimise_nlopt.hpp"

namespace tilth {
namespace {

constexpr double min_length = 0.05;
constexpr double max_length = 20.0;
constexpr double min_nugget = 1e-8;
constexpr double max_nugget = 1.0;

Eigen::Index num_trend_terms(EmulatorTrend trend, Eigen::Index d) {
  return trend == EmulatorTrend::linear ? 1 + d : 1 + d + d * (d + 1) / 2;
}

double correlation(EmulatorKernel kernel, double distance, double length) {
  const double x = std::abs(distance) / length;
  if (kernel == EmulatorKernel::squared_exponential) return std::exp(-0.5 * x * x);
  const double a = std::sqrt(5.0) * x;
  return (1.0 + a + a * a / 3.0) * std::exp(-a);
}

double log_determinant_of_square(const Eigen::MatrixXd& triangular) {
  return 2.0 * triangular.diagonal().array().abs().log().sum();
}

}  // namespace

Eigen::Index min_emulator_points(EmulatorTrend trend, Eigen::Index num_dimensions) {
  return num_trend_terms(trend, num_dimensions) + 2;
}

Emulator::Emulator(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                   const EmulatorOptions& options)
    : options_(options), points_(points) {
  assert(points.cols() == values.size());
  assert(points.cols() >= min_emulator_points(options.trend, points.rows()));
  offset_ = values.mean();
  const double spread = std::sqrt((values.array() - offset_).square().mean());
  scale_ = spread > 0.0 ? spread : 1.0;
  values_ = (values.array() - offset_) / scale_;
  trend_.resize(points.cols(), num_trend_terms(options.trend, points.rows()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) trend_.row(i) = trend_terms(points.col(i));
  choose_hyperparameters();
}

Eigen::VectorXd Emulator::trend_terms(const Eigen::VectorXd& point) const {
  const Eigen::Index d = point.size();
  Eigen::VectorXd terms(num_trend_terms(options_.trend, d));
  terms[0] = 1.0;
  terms.segment(1, d) = point;
  if (options_.trend == EmulatorTrend::quadratic) {
    Eigen::Index next = 1 + d;
    for (Eigen::Index i = 0; i < d; ++i) {
      for (Eigen::Index j = i; j < d; ++j) terms[next++] = point[i] * point[j];
    }
  }
  return terms;
}

Eigen::VectorXd Emulator::correlations(const Eigen::VectorXd& point,
                                       const Eigen::VectorXd& lengths) const {
  Eigen::VectorXd r = Eigen::VectorXd::Ones(points_.cols());
  for (Eigen::Index i = 0; i < points_.cols(); ++i) {
    for (Eigen::Index j = 0; j < point.size(); ++j) {
      r[i] *= correlation(options_.kernel, point[j] - points_(j, i), lengths[j]);
    }
  }
  return r;
}

Emulator::Solution Emulator::solve(const Eigen::VectorXd& lengths, double nugget) const {
  const Eigen::Index n = points_.cols();
  const Eigen::Index p = trend_.cols();
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i) k.col(i) = correlations(points_.col(i), lengths);
  k.diagonal().array() += nugget;

  Solution s;
  s.objective = std::numeric_limits<double>::infinity();
  const Eigen::LLT<Eigen::MatrixXd> factor(k);
  if (factor.info() != Eigen::Success) return s;
  s.lower = factor.matrixL();
  const auto lower = s.lower.triangularView<Eigen::Lower>();
  s.white_trend = lower.solve(trend_);
  const Eigen::VectorXd white_values = lower.solve(values_);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(s.white_trend);
  s.trend_factor = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  if ((s.trend_factor.diagonal().array().abs() < 1e-12).any()) return s;  // trend not determined

  s.beta = qr.solve(white_values);
  const Eigen::VectorXd white_rest = white_values - s.white_trend * s.beta;
  s.weights = s.lower.transpose().triangularView<Eigen::Upper>().solve(white_rest);
  const auto freedom = static_cast<double>(n - p);
  s.variance = std::max(white_rest.squaredNorm() / freedom, 1e-24);  // exact trend: keep ln finite
  s.objective = freedom * std::log(s.variance) + log_determinant_of_square(s.lower) +
                log_determinant_of_square(s.trend_factor);
  return s;
}

void Emulator::choose_hyperparameters() {
  const Eigen::Index d = points_.rows();
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(d + 1, std::log(min_length));
  Eigen::VectorXd upper = Eigen::VectorXd::Constant(d + 1, std::log(max_length));
  lower[d] = std::log(min_nugget);
  upper[d] = std::log(max_nugget);
  const auto objective = [&](const Eigen::VectorXd& x) {
    return solve(x.head(d).array().exp(), std::exp(x[d])).objective;
  };

  NloptResult best;
  best.value = std::numeric_limits<double>::infinity();
  for (const double length : {0.5, 2.0}) {
    Eigen::VectorXd start = Eigen::VectorXd::Constant(d + 1, std::log(length));
    start[d] = std::log(1e-3);
    const NloptResult found = minimise_with_nlopt(
        objective, lower, upper, start, {NloptAlgorithm::sbplx, options_.max_evaluations, 1e-3, 1});
    if (best.x.size() == 0 || found.value < best.value) best = found;
  }
  lengths_ = best.x.head(d).array().exp();
  nugget_ = std::exp(best.x[d]);
  solution_ = solve(lengths_, nugget_);
}

double Emulator::predict_mean(const Eigen::VectorXd& point) const {
  const double scaled =
      trend_terms(point).dot(solution_.beta) + correlations(point, lengths_).dot(solution_.weights);
  return offset_ + scale_ * scaled;
}

EmulatorPrediction Emulator::predict(const Eigen::VectorXd& point) const {
  EmulatorPrediction p = predict(correlations(point, lengths_), trend_terms(point), 1.0);
  p.mean += offset_;
  return p;
}

EmulatorPrediction Emulator::predict_difference(const Eigen::VectorXd& high, const Eigen::VectorXd& low) const {
  double together = 1.0;  // correlation of the two
  for (Eigen::Index j = 0; j < high.size(); ++j) together *= correlation(options_.kernel, high[j] - low[j], lengths_[j]);
  return predict(correlations(high, lengths_) - correlations(low, lengths_), trend_terms(high) - trend_terms(low),
                 2.0 * (1.0 - together));
}

EmulatorPrediction Emulator::predict(const Eigen::VectorXd& r, const Eigen::VectorXd& f, double prior) const {
  const Eigen::VectorXd white = solution_.lower.triangularView<Eigen::Lower>().solve(r);
  // Universal kriging: prior - r'K^-1 r + h' (F'K^-1 F)^-1 h with h = f - F'K^-1 r.
  const Eigen::VectorXd h = f - solution_.white_trend.transpose() * white;
  const Eigen::VectorXd white_h =
      solution_.trend_factor.transpose().triangularView<Eigen::Lower>().solve(h);
  const double share = std::max(0.0, prior - white.squaredNorm() + white_h.squaredNorm());
  const double mean = f.dot(solution_.beta) + r.dot(solution_.weights);
  return {scale_ * mean, scale_ * scale_ * solution_.variance * share};
}

LeaveOneOut Emulator::leave_one_out() const {
  // With Q = K^-1 - K^-1 F (F'K^-1 F)^-1 F'K^-1:  residual_i = (Q y)_i / Q_ii, variance s^2 / Q_ii.
  const Eigen::Index n = points_.cols();
  const auto lower = solution_.lower.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd white_identity = lower.solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd white_both = solution_.white_trend.transpose() * white_identity;
  const Eigen::MatrixXd projected =
      solution_.trend_factor.transpose().triangularView<Eigen::Lower>().solve(white_both);
  const Eigen::ArrayXd q_diagonal = white_identity.colwise().squaredNorm().transpose().array() -
                                    projected.colwise().squaredNorm().transpose().array();
  LeaveOneOut result;
  result.residuals = scale_ * (solution_.weights.array() / q_diagonal);
  result.standard_deviations = scale_ * (solution_.variance / q_diagonal).sqrt();
  const double total = scale_ * scale_ * values_.squaredNorm();
  result.q2 = total > 0.0 ? 1.0 - result.residuals.squaredNorm() / total : 1.0;
  return result;
}

}  // namespace tilth
