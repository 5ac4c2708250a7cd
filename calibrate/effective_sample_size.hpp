// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// How many independent values a correlated series is worth.
#pragma once

#include <span>

namespace tilth {

/// Number of independent values whose mean is as sure as the mean of this series.
///
///   n_eff = n / (1 + 2 sum_k rho_k),   rho_k = autocorrelation at lag k about the series' own mean
///
/// The sum is Geyer's initial positive sequence: pairs rho_2m + rho_2m+1 are added until the first
/// that is not positive, since the estimates behind it are noise. For a first-order autoregression
/// with coefficient phi, n_eff -> n (1 - phi) / (1 + phi). Limits: a series whose neighbours
/// alternate (phi < 0) is never worth more than n; a trend is correlation too and must be taken off
/// first if it is signal.
/// @return in [1, n]; 1 for a constant series; 0 for an empty one
/// @source Geyer, Statistical Science 7 (1992) 473, section 3.3
/// @cost O(n times the lag at which the sum ends)
double effective_sample_size(std::span<const double> series);

}  // namespace tilth
