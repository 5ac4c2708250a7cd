// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Medians, quantiles and ratios of simulation counts over twins.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tilth::bench {

/// Simulations to a floor, one per twin, in order of twins. Empty: not reached.
using Counts = std::vector<std::optional<std::size_t>>;

/// Values of a sample of counts; those that are empty count as `cap`.
double median(const Counts& counts, std::size_t cap);
/// Smallest count that at least `share` of the sample does not exceed.
double quantile(const Counts& counts, double share, std::size_t cap);
/// Number that were reached.
std::size_t num_reached(const Counts& counts);

struct Ratio {
  double value = 0.0;
  double lo95 = 0.0;
  double hi95 = 0.0;
};

/// median(counts) / least median of `others`, with a percentile bootstrap over the twins: all
/// methods of a resample have the same twins, and the best of the others is chosen anew.
Ratio ratio_to_best(const Counts& counts, const std::vector<Counts>& others, std::size_t cap);

}  // namespace tilth::bench
