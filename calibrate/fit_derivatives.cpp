// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <cmath>
#include <vector>

#include "calibrate/extrapolated_derivatives.hpp"
#include "calibrate/fit_stages.hpp"

namespace tilth {
namespace {

constexpr double most_noise = 0.1;  // share in the square of a derivative
constexpr int most_doublings = 2;
constexpr double widest_step = 0.25;  // of the unit cube
constexpr double median_of_chi_square = 0.45493642;  // one degree of freedom

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Eigen::VectorXd widened(const Eigen::VectorXd& steps, const Eigen::VectorXi& doublings) {
  const Eigen::ArrayXd factor = doublings.cast<double>().unaryExpr([](double n) { return std::exp2(n); });
  return (steps.array() * factor).cwiseMin(widest_step).cwiseMax(steps.array());
}

// Share of noise in the square of the derivatives by each free parameter; 0 where not known.
Eigen::VectorXd noise_shares(const FitContext& context, const Secants& secants) {
  const Eigen::MatrixXd noise = noise_in_products(context, secants);
  const Eigen::MatrixXd jacobian =
      residual_jacobian(context, secants.jacobian, context.options.num_search_seeds);
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(jacobian.cols());
  for (Eigen::Index j = 0; j < noise.cols(); ++j) {
    const double square = jacobian.col(j).squaredNorm();
    if (square > 0.0) shares[j] = noise(j, j) / square;
  }
  return shares;
}

// Noise goes with the step to the power of -2: twice the step has a quarter of it.
Eigen::VectorXi doublings_wanted(const Eigen::VectorXd& shares, const Eigen::VectorXi& now) {
  Eigen::VectorXi wanted = now;
  for (Eigen::Index j = 0; j < now.size(); ++j) {
    if (shares[j] > most_noise) wanted[j] = std::min(most_doublings, now[j] + 1);
    if (4.0 * shares[j] <= most_noise) wanted[j] = std::max(0, now[j] - 1);
  }
  return wanted;
}

}  // namespace

std::optional<Secants> derivatives_at(const FitContext& context, Evaluator& evaluator,
                                      const Eigen::VectorXd& unit,
                                      std::span<const std::uint64_t> seeds) {
  const FitOptions& options = context.options;
  if (options.derivatives == DerivativeRule::extrapolated) {
    return extrapolated_derivatives(evaluator, context.parameters, context.targets, unit, seeds);
  }
  const Eigen::VectorXd steps =
      secant_steps(context.parameters, options.log_step, options.linear_step);
  return paired_secants(evaluator, context.parameters, context.targets, unit, steps, seeds);
}

std::optional<Secants> search_derivatives_at(FitContext& context, const Eigen::VectorXd& unit) {
  const FitOptions& options = context.options;
  const auto seeds = stage_seeds(options, SeedUse::search, options.num_search_seeds);
  if (options.derivatives == DerivativeRule::extrapolated)
    return derivatives_at(context, context.search, unit, seeds);

  const Eigen::VectorXd narrow =
      secant_steps(context.parameters, options.log_step, options.linear_step);
  Eigen::VectorXi& doublings = context.secant_doublings;
  if (doublings.size() == 0) doublings = Eigen::VectorXi::Zero(narrow.size());
  while (true) {
    const Eigen::VectorXd steps = widened(narrow, doublings);
    auto secants =
        paired_secants(context.search, context.parameters, context.targets, unit, steps, seeds);
    if (!secants) return secants;
    if (doublings.isZero() && secants->second_differences.cols() > 0) {
      context.second_differences.emplace(std::vector<double>(unit.begin(), unit.end()),
                                         secants->second_differences);
    }
    const Eigen::VectorXi wanted = doublings_wanted(noise_shares(context, *secants), doublings);
    const Eigen::VectorXi more = wanted.cwiseMax(doublings);
    const bool is_wide_enough = widened(narrow, more) == steps;
    doublings = is_wide_enough ? wanted : more;
    if (is_wide_enough) return secants;
  }
}

Eigen::MatrixXd noise_in_products(const FitContext& context, const Secants& secants) {
  if (context.second_differences.empty()) return {};
  const Eigen::VectorXd sigmas = fitted_sigmas(context, context.options.num_search_seeds);
  double scaled = 0.0;
  for (std::size_t i = 0; i < context.fitted.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(context.fitted[i]);
    std::vector<double> squares;
    for (const auto& [point, differences] : context.second_differences) {
      for (const double d : differences.row(k)) squares.push_back(d * d);
    }
    const double sigma = sigmas[static_cast<Eigen::Index>(i)];
    scaled += median(squares) / (median_of_chi_square * 6.0) / (sigma * sigma);
  }
  return scaled * secants.noise_shape;
}

double derivative_error_share(const FitOptions& options) {
  return options.derivatives == DerivativeRule::extrapolated ? 1e-10 : 1e-3;
}

}  // namespace tilth
