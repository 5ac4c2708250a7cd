// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/steady_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace tilth {
namespace {

constexpr std::size_t fewest_blocks = 8;

double mean_of(std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

/// Squares of the deviations from the mean.
double scatter_of(std::span<const double> x) {
  const double mean = mean_of(x);
  double sum = 0.0;
  for (const double v : x) sum += (v - mean) * (v - mean);
  return sum;
}

/// What to cut off so that the mean of the rest is surest, at most `at_most` entries at either end.
Window surest(std::span<const double> x, std::size_t at_most) {
  Window best{0, x.size()};
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t begin = 0; begin <= at_most; ++begin)
    for (std::size_t cut = 0; cut <= at_most; ++cut) {
      const Window w{begin, x.size() - cut};
      const auto n = static_cast<double>(w.size());
      const double error2 = scatter_of(x.subspan(w.begin, w.size())) / (n * n);
      if (error2 >= smallest) continue;
      smallest = error2;
      best = w;
    }
  return best;
}

double correlation_time(std::span<const double> centred, double scatter) {
  const auto at_lag = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < centred.size(); ++i) sum += centred[i] * centred[i - lag];
    return sum / scatter;
  };
  double tau = -1.0;  // 1 + 2 sum over k >= 1 = -1 + 2 sum over k >= 0
  for (std::size_t lag = 0; lag + 1 < centred.size(); lag += 2) {
    const double pair = at_lag(lag) + at_lag(lag + 1);
    if (!(pair > 0)) break;
    tau += 2 * pair;
  }
  return std::clamp(tau, 1.0, 0.5 * static_cast<double>(centred.size()));
}

}  // namespace

Window steady_window(std::span<const double> series, std::size_t block) {
  const std::size_t num_blocks = series.size() / block;
  if (num_blocks < fewest_blocks) return {0, series.size()};
  std::vector<double> means;
  for (std::size_t k = 0; k < num_blocks; ++k)
    means.push_back(mean_of(series.subspan(k * block, block)));
  const Window w = surest(means, num_blocks / 4);
  return {w.begin * block, w.end == num_blocks ? series.size() : w.end * block};
}

MeanWithError mean_with_error(std::span<const double> series) {
  if (series.empty()) return {};
  MeanWithError result{mean_of(series), std::numeric_limits<double>::quiet_NaN(), 1.0};
  const auto n = static_cast<double>(series.size());
  if (series.size() < 4) return result;
  const double scatter = scatter_of(series);
  if (!(scatter > 0)) return {result.mean, 0.0, n};
  std::vector<double> centred(series.begin(), series.end());
  for (double& v : centred) v -= result.mean;
  const double tau = correlation_time(centred, scatter);
  result.num_independent = n / tau;
  result.standard_error = std::sqrt(scatter / (n - tau) * tau / n);
  return result;
}

}  // namespace tilth
