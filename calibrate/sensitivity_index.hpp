// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// One sensitivity index: what every method reports.
#pragma once

#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

namespace tilth {

enum class IndexKind {
  mu,            ///< Morris: mean elementary effect
  mu_star,       ///< Morris: mean absolute elementary effect
  sigma,         ///< Morris: standard deviation of the elementary effects
  first_order,   ///< Sobol S: variance of the mean at a fixed parameter, over the variance
  total,         ///< Sobol ST: S and all interactions of the parameter
  second_order,  ///< Sobol S_ij: the interaction of two parameters alone
};

std::string_view to_string(IndexKind kind);  ///< "mu", "mu_star", "sigma", "S", "ST", "Sij"

/// Elementary effects are per unit of the unit cube, in the scale of the feature; shares are of the
/// variance due to parameters. NaN where a number is not known.
struct IndexEstimate {
  IndexKind kind = IndexKind::first_order;
  std::size_t parameter = 0;  ///< position among the free parameters
  std::size_t other = 0;      ///< the second one of second_order, > parameter; else == parameter
  double value = std::numeric_limits<double>::quiet_NaN();
  double low95 = std::numeric_limits<double>::quiet_NaN();  ///< bootstrap over rows
  double high95 = std::numeric_limits<double>::quiet_NaN();
  double bound_low = std::numeric_limits<double>::quiet_NaN();   ///< whatever the failed runs gave,
  double bound_high = std::numeric_limits<double>::quiet_NaN();  ///< see missing_bounds.hpp
  std::size_t num_values = 0;  ///< effects, differences or products averaged
};

}  // namespace tilth
