// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The parameters of a fit: bounds, scale, prior, and the mapping to the unit cube.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tilth {

/// One model parameter. Fixed parameters stay in the table and reach the simulator at `start`.
///
/// Three views of one number:
///   physical    v   in the SI unit that ends the name
///   coordinate  c = ln v if log_scale, else v       (priors, secant steps, standard errors)
///   unit        u = (c - c_lower) / (c_upper - c_lower), in [0, 1]          (optimisers)
struct Parameter {
  std::string name;                  ///< with its SI unit at the end, unique in a fit
  double lower = 0.0;                ///< physical, finite, < upper; > 0 if log_scale
  double upper = 1.0;                ///< physical, finite
  double start = 0.5;                ///< physical, in [lower, upper]; the value itself if !estimate
  bool log_scale = false;            ///< c = ln v: steps and errors are relative
  bool estimate = true;              ///< false: held at start
  std::optional<double> prior_mean;  ///< in the coordinate c; needs prior_sigma
  std::optional<double> prior_sigma;  ///< in the coordinate c, > 0: relative if log_scale
  std::optional<double> secant_step;  ///< in the coordinate c, > 0; absent: FitOptions decides
};

/// Everything wrong with the table, one sentence each; empty if it may be used.
std::vector<std::string> problems(std::span<const Parameter> parameters);

/// c of v. @pre v > 0 if log_scale
double coordinate_from_physical(const Parameter& parameter, double value);
/// v of c, the inverse of coordinate_from_physical().
double physical_from_coordinate(const Parameter& parameter, double coordinate);
/// c_upper - c_lower > 0: the length of the unit interval in the coordinate.
double coordinate_span(const Parameter& parameter);

/// u of v; exactly 0 and 1 at the bounds. @pre v in [lower, upper]
double unit_from_physical(const Parameter& parameter, double value);
/// v of u, the inverse; exactly lower and upper at (or beyond) 0 and 1.
double physical_from_unit(const Parameter& parameter, double unit);

/// Positions of the parameters with `estimate`, in table order.
std::vector<std::size_t> free_parameters(std::span<const Parameter> parameters);

/// All parameters, physical, for one point of the unit cube of the free ones.
/// @shape unit (num_free), result (num_parameters): what a Simulator expects as one column
Eigen::VectorXd physical_point(std::span<const Parameter> parameters, const Eigen::VectorXd& unit);

/// The start values of the free parameters in the unit cube. @shape (num_free)
Eigen::VectorXd unit_start(std::span<const Parameter> parameters);

}  // namespace tilth
