// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Numbers read off a curve.
#pragma once

#include "experiments/result.hpp"

namespace tilth {

/// Row with the largest entry of a column. @pre the curve has rows
std::size_t row_of_largest(const Curve& curve, std::size_t column);

/// Slope from the origin to the first point, up to row `last`, where y reaches share x y[last];
/// x is interpolated between rows.
double secant_at_share(const Curve& curve, std::size_t x, std::size_t y, std::size_t last,
                       double share);

/// x at the first crossing of y = level going upwards, searching rows [from, to); NaN if none.
double first_crossing(const Curve& curve, std::size_t x, std::size_t y, double level,
                      std::size_t from, std::size_t to);

/// Mean of a column over rows [from, to).
double mean_of(const Curve& curve, std::size_t column, std::size_t from, std::size_t to);

/// Mean of a column over the last quarter of the rows, at least one: the residual of a shear curve.
double mean_of_last_quarter(const Curve& curve, std::size_t column);

struct Line {
  double intercept = 0.0;
  double slope = 0.0;
};

/// Least-squares line through points. @pre at least two distinct x
Line fit_line(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace tilth
