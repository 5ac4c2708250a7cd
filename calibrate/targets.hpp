// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The targets of a fit: what was measured, how well, and what may not be used.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/provenance.hpp"

namespace tilth {

std::string_view to_string(Provenance provenance);

/// One number the model should reproduce.
///
/// Comparison happens in the transformed quantity T(y) = ln y if log_transform, else y.
struct Target {
  std::string name;            ///< with its SI unit at the end, unique in a fit
  double value = 0.0;          ///< in that unit; > 0 if log_transform
  double sigma = 1.0;          ///< standard error of T(value), > 0: relative if log_transform
  bool log_transform = false;  ///< compare logarithms: sigma 0.1 means 10 %
  bool holdout = false;        ///< never enters the fit, only predicted at its end
  /// Numbers derived from each other share a group and count as one observation; empty = own name.
  std::string observation_group;
  /// What is read from like tests under other conditions; seed scatter is pooled over it. May be empty.
  std::string statistic;
  Provenance provenance = Provenance::synthetic;
  std::string source;  ///< citation and locator
};

/// Everything wrong with the table, one sentence each; empty if it may be used.
std::vector<std::string> problems(std::span<const Target> targets);

/// T(y); NaN if log_transform and y <= 0.
double transformed(const Target& target, double value);
/// y of T(y), the inverse of transformed().
double untransformed(const Target& target, double transformed_value);

/// Positions of the targets that are fitted (holdout == false), in table order.
std::vector<std::size_t> fitted_targets(std::span<const Target> targets);
/// Number of distinct observation groups among the fitted targets.
std::size_t num_independent_observations(std::span<const Target> targets);

/// What a residual is divided by:  sigma_total^2 = sigma^2 + v_seed / num_seeds + v_bias.
///
/// All three are variances of T: the measurement's, the packing scatter of one simulation divided
/// by the number of packings averaged, and that of the bias correction (0 without one).
/// @pre num_seeds >= 1
double total_sigma(double sigma, double seed_variance, int num_seeds, double bias_variance);

}  // namespace tilth
