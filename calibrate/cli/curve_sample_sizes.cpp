// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/curve_sample_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calibrate/cli/triaxial_figures.hpp"
#include "calibrate/effective_sample_size.hpp"

namespace tilth {
namespace {

/// Entry of a column at x, between rows. @pre x within the curve
double value_at(const Curve& curve, std::size_t column, double x) {
  const auto above = std::ranges::lower_bound(curve.rows, x, {}, [](const auto& row) { return row[0]; });
  if (above == curve.rows.begin()) return above->at(column);
  const auto below = above - 1;
  const double share = (x - below->at(0)) / (above->at(0) - below->at(0));
  return below->at(column) + share * (above->at(column) - below->at(column));
}

}  // namespace

std::vector<CurveSampleSize> curve_sample_sizes(const MeasuredCurve& measured, const Curve& simulated) {
  if (simulated.rows.empty()) return {};
  const Curve own = triaxial_curve(measured.rows);
  const Curve other = triaxial_curve(simulated.rows);
  std::vector<CurveSampleSize> sizes;
  for (std::size_t column = 1; column < own.columns.size(); ++column) {
    std::vector<double> misfit;
    for (const std::vector<double>& row : own.rows)
      if (row[0] >= other.rows.front()[0] && row[0] <= other.rows.back()[0])
        misfit.push_back(value_at(other, column, row[0]) - row[column]);
    sizes.push_back({fmt::format("{}/{}/{}", measured.test_id, own.columns[column], measured.condition_id),
                     misfit.size(), effective_sample_size(misfit)});
  }
  return sizes;
}

}  // namespace tilth
