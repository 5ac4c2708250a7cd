// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/missing_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calibrate/emulator.hpp"

namespace tilth {
namespace {

constexpr double num_sds = 3.0;

struct TrainingSet {
  std::vector<Eigen::VectorXd> points;
  std::vector<double> values;

  void add_column(const std::vector<SampleRow>& rows, const RowOutputs& outputs, Eigen::Index i) {
    for (Eigen::Index r = 0; r < outputs.values.cols() && points.size() < max_fill_points; ++r) {
      if (std::isnan(outputs.values(i, r))) continue;
      points.push_back(rows[static_cast<std::size_t>(r)].unit.col(i));
      values.push_back(outputs.values(i, r));
    }
  }
};

std::optional<Emulator> emulator_of(const TrainingSet& set) {
  if (set.points.empty()) return {};
  const auto n = static_cast<Eigen::Index>(set.points.size());
  const Eigen::Index d = set.points.front().size();
  if (n < min_emulator_points(EmulatorTrend::linear, d)) return {};
  Eigen::MatrixXd points(d, n);
  for (Eigen::Index i = 0; i < n; ++i) points.col(i) = set.points[static_cast<std::size_t>(i)];
  return Emulator(points, Eigen::Map<const Eigen::VectorXd>(set.values.data(), n), {});
}

// The ends of the rows fill the cube best; the other columns follow while there is room.
TrainingSet training_set(const std::vector<SampleRow>& rows, const RowOutputs& outputs) {
  TrainingSet set;
  const Eigen::Index last = outputs.values.rows() - 1;
  set.add_column(rows, outputs, 0);
  if (last > 0) set.add_column(rows, outputs, last);
  for (Eigen::Index i = 1; i < last; ++i) set.add_column(rows, outputs, i);
  return set;
}

}  // namespace

std::vector<RowOutputs> filled_outputs(const std::vector<SampleRow>& rows,
                                       const RowOutputs& outputs) {
  const std::optional<Emulator> emulator = emulator_of(training_set(rows, outputs));
  if (!emulator) return {};
  const Eigen::VectorXd residuals = emulator->leave_one_out().residuals;
  const double least_variance = residuals.squaredNorm() / static_cast<double>(residuals.size());
  std::vector<RowOutputs> filled(3, outputs);
  for (Eigen::Index r = 0; r < outputs.values.cols(); ++r) {
    for (Eigen::Index i = 0; i < outputs.values.rows(); ++i) {
      if (!std::isnan(outputs.values(i, r))) continue;
      const auto guess = emulator->predict(rows[static_cast<std::size_t>(r)].unit.col(i));
      const double sd = std::sqrt(std::max(guess.variance, least_variance));
      for (int k = 0; k < 3; ++k)
        filled[static_cast<std::size_t>(k)].values(i, r) = guess.mean + num_sds * (k - 1) * sd;
    }
  }
  return filled;
}

}  // namespace tilth
