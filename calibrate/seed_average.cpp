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

Eigen::MatrixXd samples_over_seeds(Evaluator& evaluator, std::span<const Parameter> parameters,
                                   std::span<const Target> targets, const Eigen::VectorXd& unit,
                                   std::span<const std::uint64_t> seeds) {
  Eigen::MatrixXd samples(static_cast<Eigen::Index>(targets.size()), 0);
  const Eigen::MatrixXd points =
      physical_point(parameters, unit).replicate(1, static_cast<Eigen::Index>(seeds.size()));
  for (const Evaluation& run : evaluator.evaluate(points, seeds)) {
    if (run.status != EvaluationStatus::completed) continue;
    samples.conservativeResize(Eigen::NoChange, samples.cols() + 1);
    samples.rightCols(1) = transformed_features(targets, run);
  }
  return samples;
}

std::vector<std::optional<Eigen::VectorXd>> average_over_seeds(
    Evaluator& evaluator, std::span<const Parameter> parameters, std::span<const Target> targets,
    const Eigen::MatrixXd& unit_points, std::span<const std::uint64_t> seeds) {
  const Eigen::Index num_points = unit_points.cols();
  const auto num_seeds = static_cast<Eigen::Index>(seeds.size());
  Eigen::MatrixXd physical(static_cast<Eigen::Index>(parameters.size()), num_points * num_seeds);
  std::vector<std::uint64_t> seed_of_column;
  for (const std::uint64_t seed : seeds) {
    for (Eigen::Index i = 0; i < num_points; ++i) {
      physical.col(static_cast<Eigen::Index>(seed_of_column.size())) =
          physical_point(parameters, unit_points.col(i));
      seed_of_column.push_back(seed);
    }
  }
  const std::vector<Evaluation> runs = evaluator.evaluate(physical, seed_of_column);

  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(targets.size()));
  std::vector<std::optional<Eigen::VectorXd>> means(static_cast<std::size_t>(num_points), zero);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::optional<Eigen::VectorXd>& mean = means[k % means.size()];
    if (!mean) continue;
    if (runs[k].status != EvaluationStatus::completed) {
      mean.reset();
    } else {
      *mean += transformed_features(targets, runs[k]) / static_cast<double>(seeds.size());
    }
  }
  return means;
}

}  // namespace tilth
