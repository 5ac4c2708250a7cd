// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Derivatives of a simulator: finite secants on common packings.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calibrate/evaluator.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

struct Secants {
  Eigen::VectorXd base;      ///< mean T(feature) at the point, all targets
  Eigen::MatrixXd jacobian;  ///< d base / d unit coordinate (num_targets, num_free); 0 if frozen
  std::vector<std::size_t> one_sided;  ///< free parameters with one side only: first order
  std::vector<std::size_t> frozen;     ///< free parameters with no side: both perturbed runs failed
  /// m(u + h e_j) - 2 m(u) + m(u - h e_j) of parameters with both sides: (num_targets, num_central).
  /// Where the response is straight its variance is 6 v, v = variance of m among neighbouring points.
  Eigen::MatrixXd second_differences;
  /// Noise of the derivatives: covariance of d m_k / d u_i and d m_k / d u_j = v_k noise_shape(i, j).
  /// 1 / (2 h_j^2) for two sides, 2 / h_j^2 for one; one-sided ones have the run at the point in common.
  Eigen::MatrixXd noise_shape;  ///< (num_free, num_free)
};

/// Half-widths of the secants in the unit cube: a parameter's secant_step / its span, else
/// log_step / span on a log scale, else linear_step.
Eigen::VectorXd secant_steps(std::span<const Parameter> parameters, double log_step,
                             double linear_step);

/// Paired secants around one point, on the same seeds, all members of a seed in one batch.
///
///   dm/du_j = [m(u + h_j e_j) - m(u - h_j e_j)] / (2 h_j)             error O(h_j^2)
///
/// One-sided, error O(h_j), where a side would leave the unit cube or its run failed. The step is
/// larger than the noise of one fixed packing; differences between packings cancel.
/// @shape unit, steps (num_free)
/// @return empty if the point itself could not be evaluated, or runs were skipped by stop or budget
/// @cost (1 + 2 num_free) simulations per seed
std::optional<Secants> paired_secants(Evaluator& evaluator, std::span<const Parameter> parameters,
                                      std::span<const Target> targets, const Eigen::VectorXd& unit,
                                      const Eigen::VectorXd& steps,
                                      std::span<const std::uint64_t> seeds);

}  // namespace tilth
