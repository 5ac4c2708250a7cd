// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Do failed runs lie anywhere, or where certain parameters are?
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "calibrate/sample_rows.hpp"

namespace tilth {

enum class FailureVerdict {
  none,          ///< no run failed
  no_pattern,    ///< no parameter's p-value is small: indices of the completed runs are unbiased
  too_few,       ///< no pattern seen, but fewer than min_failures_for_a_pattern to see one in
  concentrated,  ///< they depend on a parameter: the completed runs are not a fair sample
};

std::string_view to_string(FailureVerdict verdict);

inline constexpr std::size_t min_failures_for_a_pattern = 8;
/// p-value below which failures are called concentrated, all parameters together.
inline constexpr double failure_significance = 0.05;

struct ParameterFailures {
  double p_value = 1.0;  ///< of "failures do not depend on this parameter"
  std::array<double, 3>
      shares{};  ///< failed in the low, middle, high third of its range; NaN: no run
};

struct FailurePattern {
  std::size_t num_runs = 0;
  std::size_t num_failed = 0;
  FailureVerdict verdict = FailureVerdict::none;
  std::vector<ParameterFailures> parameters;  ///< free ones, in order

  double share() const;  ///< num_failed / num_runs; 0 without runs
};

/// A permutation test per parameter. The runs of a row that share a value u of the parameter form
/// one unit, since they share that value's luck; c is the failed share of a unit. For the scores
/// s = u (failures at one end) and s = |u - 1/2| (at both ends, or in the middle),
///
///   z = sum (s - mean s)(c - mean c) / sqrt(sum (s - mean s)^2 sum (c - mean c)^2 / (n - 1)),
///
/// p = 2 (1 - Phi(|z|)), the smaller of the two doubled. Concentrated: smallest p times the number
/// of parameters below failure_significance (Bonferroni).
/// @limits monotone and two-sided dependence on single parameters; a corner that only a combination
///         defines shows in its parameters, weakly
/// @shape is_failed (num_points, num_rows), 1 or 0
/// @source permutation variance of a linear statistic: Hajek & Sidak, Theory of Rank Tests, 1967
FailurePattern failure_pattern(const std::vector<SampleRow>& rows,
                               const Eigen::MatrixXd& is_failed);

}  // namespace tilth
