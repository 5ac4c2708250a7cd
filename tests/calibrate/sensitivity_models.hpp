// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Functions whose sensitivity indices are known exactly, as simulators with noise and failures.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "calibrate/sensitivity.hpp"
#include "tests/calibrate/formula_models.hpp"

namespace tilth::test {

/// sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1, x uniform in (-pi, pi).
/// @source Ishigami & Homma 1990; V = 49/8 + 0.1 pi^4/5 + 0.01 pi^8/18 + 1/2
inline double ishigami(const Eigen::VectorXd& x) {
  return std::sin(x[0]) + 7.0 * std::pow(std::sin(x[1]), 2) +
         0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

struct ExactIndices {
  std::vector<double> first, total;
};
inline const ExactIndices ishigami_indices = {
    {0.31390519114781146, 0.4424111447900409, 0.0},
    {0.5575888552099592, 0.4424111447900409, 0.24368366406214773}};
inline constexpr double ishigami_variance = 13.844587940719254;
inline constexpr double ishigami_s13 = 0.24368366406214773;

inline std::vector<Parameter> ishigami_parameters() {
  constexpr double pi = std::numbers::pi;
  return {linear_parameter("x1", -pi, pi, 0.0), linear_parameter("x2", -pi, pi, 0.0),
          linear_parameter("x3", -pi, pi, 0.0)};
}

/// prod (|4 x - 2| + a) / (1 + a), x uniform in (0, 1). @source Saltelli & Sobol 1995
inline double g_function(const Eigen::VectorXd& x, const std::vector<double>& a) {
  double product = 1.0;
  for (std::size_t j = 0; j < a.size(); ++j)
    product *= (std::abs(4.0 * x[static_cast<Eigen::Index>(j)] - 2.0) + a[j]) / (1.0 + a[j]);
  return product;
}

inline std::vector<Parameter> unit_parameters(std::size_t num) {
  std::vector<Parameter> parameters;
  for (std::size_t j = 0; j < num; ++j)
    parameters.push_back(linear_parameter("x" + std::to_string(j + 1), 0.0, 1.0, 0.5));
  return parameters;
}

inline Target plain_target(const std::string& name) {
  Target target;
  target.name = name;
  return target;
}

inline Formula one_output(std::function<double(const Eigen::VectorXd&)> f) {
  return [f](const Eigen::VectorXd& x) { return Eigen::VectorXd::Constant(1, f(x)).eval(); };
}

/// A word that depends on the point alone.
inline std::uint64_t word_of(const Eigen::VectorXd& p) {
  std::uint64_t word = 0;
  for (const double value : p) word = scrambled(word ^ std::bit_cast<std::uint64_t>(value));
  return word;
}

enum class NoiseKind {
  shared,      ///< a packing adds one number to all parameter sets
  independent  ///< every run has a number of its own
};

/// f + sd * normal number.
inline Simulator noisy(std::function<double(const Eigen::VectorXd&)> f, double sd, NoiseKind kind,
                       std::uint64_t stream = 5) {
  return [=](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    std::vector<Evaluation> runs;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      const Eigen::VectorXd x = parameters.col(i);
      const std::uint64_t index = kind == NoiseKind::shared ? 0 : word_of(x);
      const double noise =
          sd > 0.0 ? sd * normal_number(stream, seeds[static_cast<std::size_t>(i)], index) : 0.0;
      runs.push_back({EvaluationStatus::completed, Eigen::VectorXd::Constant(1, f(x) + noise), ""});
    }
    return runs;
  };
}

inline SensitivityOptions study(SensitivityMethod method, int num_rows, std::uint64_t seed = 1,
                                int num_packings = 8) {
  SensitivityOptions options;
  options.method = method;
  options.num_rows = num_rows;
  options.packings = {seed, num_packings};
  options.num_resamples = 100;
  return options;
}

/// Estimate of one index of the first feature.
inline IndexEstimate index_of(const SensitivitySummary& s, IndexKind kind, std::size_t j,
                              std::size_t other) {
  for (const IndexEstimate& i : s.features.front().indices)
    if (i.kind == kind && i.parameter == j && i.other == other) return i;
  return {};
}
inline IndexEstimate index_of(const SensitivitySummary& s, IndexKind kind, std::size_t j) {
  return index_of(s, kind, j, j);
}

}  // namespace tilth::test
