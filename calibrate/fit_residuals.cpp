// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/fit_stages.hpp"

namespace tilth {

std::vector<std::uint64_t> stage_seeds(const FitOptions& options, SeedUse use, int num) {
  std::vector<std::uint64_t> seeds;
  for (int i = 0; i < num; ++i) {
    seeds.push_back(options.seed + static_cast<std::uint64_t>(use) + static_cast<std::uint64_t>(i));
  }
  return seeds;
}

Eigen::VectorXd model_variance(const FitContext& context, int num_seeds) {
  if (context.num_bias_seeds > 0) return context.confirm_variance / context.num_bias_seeds;
  return context.seed_variance / num_seeds;
}

Eigen::VectorXd fitted_sigmas(const FitContext& context, int num_seeds) {
  const Eigen::VectorXd variance = model_variance(context, num_seeds);
  Eigen::VectorXd sigmas(static_cast<Eigen::Index>(context.fitted.size()));
  for (std::size_t i = 0; i < context.fitted.size(); ++i) {
    const std::size_t k = context.fitted[i];
    sigmas[static_cast<Eigen::Index>(i)] =
        total_sigma(context.targets[k].sigma, variance[static_cast<Eigen::Index>(k)], 1, 0.0);
  }
  return sigmas;
}

std::size_t num_priors(const FitContext& context) {
  std::size_t count = 0;
  for (const std::size_t i : context.free) count += context.parameters[i].prior_sigma ? 1 : 0;
  return count;
}

Eigen::VectorXd fit_residuals(const FitContext& context, const Eigen::VectorXd& unit,
                              const Eigen::VectorXd& mean, int num_seeds) {
  const Eigen::VectorXd sigmas = fitted_sigmas(context, num_seeds);
  Eigen::VectorXd residuals(sigmas.size() + static_cast<Eigen::Index>(num_priors(context)));
  Eigen::Index row = 0;
  for (const std::size_t target : context.fitted) {
    const auto k = static_cast<Eigen::Index>(target);
    const double wanted = transformed(context.targets[target], context.targets[target].value);
    residuals[row] = (mean[k] + context.bias[k] - wanted) / sigmas[row];
    ++row;
  }
  for (std::size_t j = 0; j < context.free.size(); ++j) {
    const Parameter& p = context.parameters[context.free[j]];
    if (!p.prior_sigma) continue;
    const double value = physical_from_unit(p, unit[static_cast<Eigen::Index>(j)]);
    residuals[row++] = (coordinate_from_physical(p, value) - *p.prior_mean) / *p.prior_sigma;
  }
  return residuals;
}

Eigen::MatrixXd residual_jacobian(const FitContext& context,
                                  const Eigen::MatrixXd& feature_jacobian, int num_seeds) {
  const Eigen::VectorXd sigmas = fitted_sigmas(context, num_seeds);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(
      sigmas.size() + static_cast<Eigen::Index>(num_priors(context)), feature_jacobian.cols());
  Eigen::Index row = 0;
  for (const std::size_t target : context.fitted) {
    jacobian.row(row) = feature_jacobian.row(static_cast<Eigen::Index>(target)) / sigmas[row];
    ++row;
  }
  for (std::size_t j = 0; j < context.free.size(); ++j) {
    const Parameter& p = context.parameters[context.free[j]];
    if (!p.prior_sigma) continue;
    jacobian(row++, static_cast<Eigen::Index>(j)) = coordinate_span(p) / *p.prior_sigma;
  }
  return jacobian;
}

double r_squared(const FitContext& context) {
  const Target& first = context.targets[context.fitted.front()];
  const auto n = static_cast<Eigen::Index>(context.fitted.size());
  const Eigen::VectorXd sigmas = fitted_sigmas(context, context.optimum->num_seeds);
  Eigen::VectorXd wanted(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Target& target = context.targets[context.fitted[static_cast<std::size_t>(i)]];
    if (target.statistic != first.statistic || target.log_transform != first.log_transform) {
      return not_known;
    }
    wanted[i] = transformed(target, target.value);
  }
  if (first.statistic.empty()) return not_known;
  const Eigen::VectorXd weights = sigmas.cwiseAbs2().cwiseInverse();
  const double mean = weights.dot(wanted) / weights.sum();
  const double total = ((wanted.array() - mean) / sigmas.array()).square().sum();
  const Eigen::VectorXd residuals = fit_residuals(
      context, context.optimum->unit, context.optimum->mean, context.optimum->num_seeds);
  return total > 0.0 ? 1.0 - residuals.head(n).squaredNorm() / total : not_known;
}

int degrees_of_freedom(const FitContext& context) {
  const std::size_t num_observations = context.fitted.size() + num_priors(context);
  return static_cast<int>(num_observations) - static_cast<int>(context.free.size());
}

double sigma_scale(const FitContext& context) {
  if (!context.options.rescale_sigma) return 1.0;
  const int freedom = degrees_of_freedom(context);
  if (freedom < 1) return not_known;
  // An exact fit would give parameters without any error, and 0 / 0 on the way.
  const double least = std::numeric_limits<double>::min();
  return std::sqrt(std::max(least, context.optimum->chi_square / freedom));
}

void record_cost(FitContext& context, double chi_square) {
  context.summary.history.push_back({context.ledger.stage, context.ledger.num_done, chi_square});
}

}  // namespace tilth
