// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Does a count agree with a probability?
#pragma once

#include <cmath>

namespace tilth::test {

/// P(X <= k) of a binomial distribution of n trials with probability p, summed from its logarithms.
inline double binomial_cdf(int k, int n, double p) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    i * std::log(p) + (n - i) * std::log1p(-p));
  }
  return sum;
}

/// The smaller of P(X <= k) and P(X >= k): an exact one-sided p-value on the side of k.
inline double binomial_tail(int k, int n, double p) {
  return std::fmin(binomial_cdf(k, n, p), 1.0 - binomial_cdf(k - 1, n, p));
}

}  // namespace tilth::test
