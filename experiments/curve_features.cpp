// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/curve_features.hpp"

#include <algorithm>
#include <limits>

namespace tilth {

std::size_t row_of_largest(const Curve& curve, std::size_t column) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < curve.rows.size(); ++k)
    if (curve.rows[k][column] > curve.rows[best][column]) best = k;
  return best;
}

double first_crossing(const Curve& curve, std::size_t x, std::size_t y, double level,
                      std::size_t from, std::size_t to) {
  for (std::size_t k = from; k < to; ++k) {
    const double y1 = curve.rows[k][y];
    if (y1 < level) continue;
    if (k == from) {
      // Before the first row the curve is the straight line from the origin.
      if (from > 0 || y1 <= 0) return curve.rows[k][x];
      return curve.rows[k][x] * level / y1;
    }
    const double y0 = curve.rows[k - 1][y];
    const double x0 = curve.rows[k - 1][x];
    return x0 + (curve.rows[k][x] - x0) * (level - y0) / (y1 - y0);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double secant_at_share(const Curve& curve, std::size_t x, std::size_t y, std::size_t last,
                       double share) {
  const double level = share * curve.rows[last][y];
  return level / first_crossing(curve, x, y, level, 0, last + 1);
}

double mean_of(const Curve& curve, std::size_t column, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t k = from; k < to; ++k) sum += curve.rows[k][column];
  return sum / static_cast<double>(to - from);
}

double mean_of_last_quarter(const Curve& curve, std::size_t column) {
  const std::size_t n = curve.rows.size();
  return mean_of(curve, column, n - std::max<std::size_t>(n / 4, 1), n);
}

Line fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    sx += x[k];
    sy += y[k];
    sxx += x[k] * x[k];
    sxy += x[k] * y[k];
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return {(sy - slope * sx) / n, slope};
}

}  // namespace tilth
