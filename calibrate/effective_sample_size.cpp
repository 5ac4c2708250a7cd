// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/effective_sample_size.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tilth {
namespace {

double product_at_lag(std::span<const double> centred, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < centred.size(); ++i) sum += centred[i] * centred[i - lag];
  return sum;
}

}  // namespace

double effective_sample_size(std::span<const double> series) {
  if (series.empty()) return 0.0;
  const auto n = static_cast<double>(series.size());
  const double mean = std::accumulate(series.begin(), series.end(), 0.0) / n;
  std::vector<double> centred(series.begin(), series.end());
  for (double& value : centred) value -= mean;
  const double square = product_at_lag(centred, 0);
  if (!(square > 0.0)) return 1.0;
  double correlation_time = -1.0;  // 1 + 2 sum over k >= 1 = -1 + 2 sum over k >= 0
  for (std::size_t lag = 0; lag + 1 < centred.size(); lag += 2) {
    const double pair = (product_at_lag(centred, lag) + product_at_lag(centred, lag + 1)) / square;
    if (pair <= 0.0) break;
    correlation_time += 2.0 * pair;
  }
  return std::clamp(n / std::max(correlation_time, 1.0), 1.0, n);
}

}  // namespace tilth
