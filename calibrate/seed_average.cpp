// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/seed_average.hpp"

namespace tilth {

Eigen::VectorXd transformed_features(std::span<const Target> targets, const Evaluation& run) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(targets.size()));
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto index = static_cast<Eigen::Index>(k);
    result[index] = transformed(targets[k], run.features[index]);
  }
  return result;
}

std::vector<std::optional<Eigen::VectorXd>> average_over_seeds(
    Evaluator& evaluator, std::span<const Parameter> parameters, std::span<const Target> targets,
    const Eigen::MatrixXd& unit_points, std::span<const std::uint64_t> seeds) {
  const Eigen::Index num_points = unit_points.cols();
  Eigen::MatrixXd physical(static_cast<Eigen::Index>(parameters.size()), num_points);
  for (Eigen::Index i = 0; i < num_points; ++i) {
    physical.col(i) = physical_point(parameters, unit_points.col(i));
  }

  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(targets.size()));
  std::vector<std::optional<Eigen::VectorXd>> means(static_cast<std::size_t>(num_points), zero);
  for (const std::uint64_t seed : seeds) {
    const std::vector<Evaluation> runs = evaluator.evaluate(physical, seed);
    for (std::size_t i = 0; i < means.size(); ++i) {
      if (!means[i]) continue;
      if (runs[i].status != EvaluationStatus::completed) {
        means[i].reset();
      } else {
        *means[i] += transformed_features(targets, runs[i]) / static_cast<double>(seeds.size());
      }
    }
  }
  return means;
}

}  // namespace tilth
