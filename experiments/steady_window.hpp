// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Which part of a series is steady, and how sure the mean over it is.
#pragma once

#include <cstddef>
#include <span>

namespace tilth {

/// Entries [begin, end) of a series.
struct Window {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

/// The steady part of a series: what a transient at either end spoils is left out.
///
/// Means over `block` entries x_1 .. x_n; the numbers of blocks cut off at the beginning and at the
/// end minimise
///   sum (x_k - mean)^2 / m^2   over the m blocks left,
/// the squared standard error of their mean. At most a quarter of the blocks is cut at each end, so
/// that a drift over all of it is not cut down to its last stretch.
/// @param block  entries per mean, >= 1; a series of fewer than 8 blocks is returned whole
/// @source marginal standard error rule: White, Simulation 69 (1997) 323-334; both ends at once:
/// own choice
Window steady_window(std::span<const double> series, std::size_t block);

struct MeanWithError {
  double mean = 0.0;
  double standard_error = 0.0;  ///< NaN for fewer than 4 entries
  double num_independent = 0.0;
};

/// Mean of a correlated series and its standard error.
///
///   se^2 = s^2 tau / n,   s^2 = sum (x - mean)^2 / (n - tau),   tau = 1 + 2 sum_k rho_k
///
/// with the autocorrelations rho_k summed as Geyer's initial positive sequence, 1 <= tau <= n / 2.
/// For a first-order autoregression of coefficient phi, tau -> (1 + phi) / (1 - phi). n - tau takes
/// out that the scatter about the own mean is smaller by the variance of that mean.
/// @source Geyer, Statistical Science 7 (1992) 473, section 3.3. calibrate/effective_sample_size
/// has the
///         same sum; neither room may include the other.
MeanWithError mean_with_error(std::span<const double> series);

}  // namespace tilth
