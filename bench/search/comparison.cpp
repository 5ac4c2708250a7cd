// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "bench/search/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace tilth::bench {
namespace {

constexpr int num_resamples = 4000;

std::vector<double> sorted(const Counts& counts, std::size_t cap) {
  std::vector<double> values;
  for (const auto& count : counts) values.push_back(static_cast<double>(count.value_or(cap)));
  std::sort(values.begin(), values.end());
  return values;
}

Counts picked(const Counts& counts, const std::vector<std::size_t>& twins) {
  Counts result;
  for (const std::size_t twin : twins) result.push_back(counts[twin]);
  return result;
}

double least_median(const std::vector<Counts>& all, const std::vector<std::size_t>& twins,
                    std::size_t cap) {
  double least = std::numeric_limits<double>::infinity();
  for (const Counts& counts : all) least = std::min(least, median(picked(counts, twins), cap));
  return least;
}

}  // namespace

double median(const Counts& counts, std::size_t cap) {
  const std::vector<double> values = sorted(counts, cap);
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double quantile(const Counts& counts, double share, std::size_t cap) {
  const std::vector<double> values = sorted(counts, cap);
  const auto rank = std::ceil(share * static_cast<double>(values.size()) - 1e-9);
  return values[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

std::size_t num_reached(const Counts& counts) {
  return static_cast<std::size_t>(
      std::ranges::count_if(counts, [](const auto& count) { return count.has_value(); }));
}

Ratio ratio_to_best(const Counts& counts, const std::vector<Counts>& others, std::size_t cap) {
  std::vector<std::size_t> twins(counts.size());
  for (std::size_t i = 0; i < twins.size(); ++i) twins[i] = i;
  Ratio ratio;
  ratio.value = median(counts, cap) / least_median(others, twins, cap);
  std::mt19937_64 rng(1);
  std::vector<double> resampled;
  for (int i = 0; i < num_resamples; ++i) {
    for (std::size_t& twin : twins) twin = static_cast<std::size_t>(rng() % counts.size());
    resampled.push_back(median(picked(counts, twins), cap) / least_median(others, twins, cap));
  }
  std::sort(resampled.begin(), resampled.end());
  ratio.lo95 = resampled[num_resamples / 40];
  ratio.hi95 = resampled[num_resamples - 1 - num_resamples / 40];
  return ratio;
}

}  // namespace tilth::bench
