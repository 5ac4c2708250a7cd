// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <cmath>
#include <map>

#include "calibrate/fit_stages.hpp"
#include "calibrate/moderated_variances.hpp"
#include "calibrate/seed_average.hpp"

namespace tilth {
namespace {

// Weight of the pooled variance, in degrees of freedom.
constexpr double prior_freedom = 8.0;

// A statistic read from at least three fitted tests is pooled over them; the rest over each other.
constexpr std::size_t own_pool = 3;

std::string pool_of(const FitContext& context, const Target& target) {
  const auto same = [&](std::size_t k) {
    return context.targets[k].statistic == target.statistic;
  };
  const bool own = static_cast<std::size_t>(std::ranges::count_if(context.fitted, same)) >= own_pool;
  return own ? target.statistic : "";
}

// What makes variances of one pool comparable: T is relative already on a log scale, and one
// statistic has one unit; else the size of the mean simulated value.
double pooling_scale(const Target& target, const std::string& pool, double mean) {
  if (target.log_transform || !pool.empty()) return 1.0;
  return mean != 0.0 ? std::abs(mean) : target.sigma;
}

// Mean variance of the fitted targets of each pool, brought back to each target's scale.
Eigen::VectorXd pooled_variance(const FitContext& context, const Eigen::MatrixXd& samples) {
  const Eigen::VectorXd variance = sample_variances(samples);
  std::vector<std::string> pool;
  Eigen::VectorXd scale(samples.rows());
  for (std::size_t k = 0; k < context.targets.size(); ++k) {
    const auto index = static_cast<Eigen::Index>(k);
    pool.push_back(pool_of(context, context.targets[k]));
    scale[index] = pooling_scale(context.targets[k], pool[k], samples.row(index).mean());
  }
  std::map<std::string, std::pair<double, int>> sums;
  for (const std::size_t target : context.fitted) {
    const auto k = static_cast<Eigen::Index>(target);
    auto& [sum, count] = sums[pool[target]];
    sum += variance[k] / (scale[k] * scale[k]);
    ++count;
  }
  Eigen::VectorXd pooled(samples.rows());
  for (std::size_t k = 0; k < context.targets.size(); ++k) {
    const auto index = static_cast<Eigen::Index>(k);
    const auto& [sum, count] = sums[pool[k]];
    pooled[index] = count > 0 ? sum / count * scale[index] * scale[index] : not_known;
  }
  return pooled;
}

// Sample correlations of the fitted targets, moderated toward their mean like the variances: one
// packing often moves all features together. Stays positive semidefinite, as both parts are.
Eigen::MatrixXd moderated_correlation(const FitContext& context, const Eigen::MatrixXd& samples) {
  const auto n = static_cast<Eigen::Index>(context.fitted.size());
  const auto freedom = static_cast<double>(samples.cols() - 1);
  Eigen::MatrixXd rest(n, samples.cols());
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(context.fitted[static_cast<std::size_t>(i)]);
    rest.row(i) = samples.row(k).array() - samples.row(k).mean();
    if (rest.row(i).norm() > 0.0) rest.row(i).normalize();
  }
  Eigen::MatrixXd sample = rest * rest.transpose();
  sample.diagonal().setOnes();
  const auto num_pairs = static_cast<double>(n * (n - 1));
  const double mean = n > 1 ? (sample.sum() - static_cast<double>(n)) / num_pairs : 0.0;
  Eigen::MatrixXd pooled = Eigen::MatrixXd::Constant(n, n, mean);
  pooled.diagonal().setOnes();
  return (prior_freedom * pooled + freedom * sample) / (prior_freedom + freedom);
}

}  // namespace

Eigen::VectorXd moderated_variance(const Eigen::MatrixXd& samples, const Eigen::VectorXd& prior) {
  return moderated_variances(samples, prior, prior_freedom);
}

Eigen::VectorXd holdout_variance(const FitContext& context, const Eigen::MatrixXd& samples,
                                 const Eigen::VectorXd& fitted_variance) {
  Eigen::VectorXd prior = sample_variances(samples);
  for (std::size_t target = 0; target < context.targets.size(); ++target) {
    double sum = 0.0;
    int count = 0;
    for (const std::size_t other : context.fitted) {
      if (context.targets[other].statistic != context.targets[target].statistic) continue;
      sum += fitted_variance[static_cast<Eigen::Index>(other)];
      ++count;
    }
    if (count > 0) prior[static_cast<Eigen::Index>(target)] = sum / count;
  }
  return moderated_variance(samples, prior);
}

Eigen::MatrixXd repeat_optimum(const FitContext& context, Evaluator& evaluator, SeedUse use, int num) {
  return samples_over_seeds(evaluator, context.parameters, context.targets, context.optimum->unit,
                            stage_seeds(context.options, use, num));
}

void run_noise(FitContext& context) {
  if (!context.optimum || context.options.num_noise_seeds < 2) return;
  begin_stage(context.ledger, "noise floor");
  const Eigen::MatrixXd samples =
      repeat_optimum(context, context.search, SeedUse::search, context.options.num_noise_seeds);
  context.summary.num_noise_seeds = static_cast<int>(samples.cols());
  if (samples.cols() < 2) {
    context.summary.warnings.emplace_back(
        "seed noise is not known: fewer than two repeats completed; it is taken as zero");
    return;
  }
  context.seed_variance = moderated_variance(samples, pooled_variance(context, samples));
  context.seed_correlation = moderated_correlation(context, samples);
}

}  // namespace tilth
