// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/row_bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace tilth {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double min_share_of_resamples = 0.8;

Eigen::VectorXd weighted_estimate(const RowTerms& terms, const RowStatistic& statistic,
                                  const Eigen::VectorXd& weights) {
  const Eigen::VectorXd counts = terms.counts * weights;
  const Eigen::VectorXd sums = terms.sums * weights;
  return statistic((counts.array() > 0).select(sums.cwiseQuotient(counts), nan_value), counts);
}

// How often each row is drawn.
Eigen::VectorXd drawn_weights(Eigen::Index num_rows, std::mt19937_64& rng) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(num_rows);
  for (Eigen::Index i = 0; i < num_rows; ++i)
    weights[static_cast<Eigen::Index>(rng() % static_cast<std::uint64_t>(num_rows))] += 1.0;
  return weights;
}

// Between the order statistics at q (n - 1), linearly. @pre sorted, not empty
double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

RowTerms::RowTerms(Eigen::Index num_terms, Eigen::Index num_rows)
    : sums(Eigen::MatrixXd::Zero(num_terms, num_rows)),
      counts(Eigen::MatrixXd::Zero(num_terms, num_rows)) {}

void RowTerms::add(Eigen::Index term, Eigen::Index row, double value) {
  if (std::isnan(value)) return;
  sums(term, row) += value;
  counts(term, row) += 1.0;
}

Eigen::VectorXd estimate(const RowTerms& terms, const RowStatistic& statistic) {
  return weighted_estimate(terms, statistic, Eigen::VectorXd::Ones(terms.sums.cols()));
}

RowEstimates bootstrap(const RowTerms& terms, const RowStatistic& statistic, int num_resamples,
                       std::uint64_t seed) {
  RowEstimates result;
  result.values = estimate(terms, statistic);
  const Eigen::Index n = result.values.size();
  std::vector<std::vector<double>> samples(static_cast<std::size_t>(n));
  std::mt19937_64 rng(seed);
  for (int b = 0; b < num_resamples; ++b) {
    const Eigen::VectorXd drawn =
        weighted_estimate(terms, statistic, drawn_weights(terms.sums.cols(), rng));
    for (Eigen::Index i = 0; i < n; ++i)
      if (std::isfinite(drawn[i])) samples[static_cast<std::size_t>(i)].push_back(drawn[i]);
  }
  result.low95 = result.high95 = Eigen::VectorXd::Constant(n, nan_value);
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double>& sample = samples[static_cast<std::size_t>(i)];
    if (sample.empty() || std::isnan(result.values[i]) ||
        static_cast<double>(sample.size()) < min_share_of_resamples * num_resamples)
      continue;
    std::ranges::sort(sample);
    result.low95[i] = quantile(sample, 0.025);
    result.high95[i] = quantile(sample, 0.975);
  }
  return result;
}

}  // namespace tilth
