// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/parameters.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace tilth {
namespace {

void check_bounds(const Parameter& p, std::vector<std::string>& found) {
  if (!std::isfinite(p.lower) || !std::isfinite(p.upper) || !std::isfinite(p.start)) {
    found.push_back(fmt::format("parameter {}: lower = {}, upper = {}, start = {}: must be finite",
                                p.name, p.lower, p.upper, p.start));
    return;
  }
  if (p.lower >= p.upper) {
    found.push_back(fmt::format("parameter {}: lower = {} must be less than upper = {}", p.name,
                                p.lower, p.upper));
  } else if (p.start < p.lower || p.start > p.upper) {
    found.push_back(fmt::format("parameter {}: start = {} must be in [{}, {}]", p.name, p.start,
                                p.lower, p.upper));
  }
  if (p.log_scale && p.lower <= 0.0) {
    found.push_back(
        fmt::format("parameter {}: lower = {} must be positive on a log scale", p.name, p.lower));
  }
}

void check_prior_and_step(const Parameter& p, std::vector<std::string>& found) {
  if (p.prior_mean.has_value() != p.prior_sigma.has_value()) {
    found.push_back(
        fmt::format("parameter {}: prior_mean and prior_sigma must be given together", p.name));
  }
  if (p.prior_mean && !std::isfinite(*p.prior_mean)) {
    found.push_back(
        fmt::format("parameter {}: prior_mean = {} must be finite", p.name, *p.prior_mean));
  }
  if (p.prior_sigma && !(std::isfinite(*p.prior_sigma) && *p.prior_sigma > 0.0)) {
    found.push_back(fmt::format("parameter {}: prior_sigma = {} must be finite and positive",
                                p.name, *p.prior_sigma));
  }
  if (p.secant_step && !(std::isfinite(*p.secant_step) && *p.secant_step > 0.0)) {
    found.push_back(fmt::format("parameter {}: secant_step = {} must be finite and positive",
                                p.name, *p.secant_step));
  }
}

}  // namespace

std::vector<std::string> problems(std::span<const Parameter> parameters) {
  std::vector<std::string> found;
  std::set<std::string> names;
  for (const Parameter& p : parameters) {
    if (p.name.empty()) found.emplace_back("a parameter has no name");
    if (!names.insert(p.name).second) {
      found.push_back(fmt::format("parameter {}: the name is used twice", p.name));
    }
    check_bounds(p, found);
    check_prior_and_step(p, found);
  }
  if (free_parameters(parameters).empty()) {
    found.emplace_back("no parameter is to be estimated: set estimate for at least one");
  }
  return found;
}

double coordinate_from_physical(const Parameter& parameter, double value) {
  return parameter.log_scale ? std::log(value) : value;
}

double physical_from_coordinate(const Parameter& parameter, double coordinate) {
  return parameter.log_scale ? std::exp(coordinate) : coordinate;
}

double coordinate_span(const Parameter& parameter) {
  return coordinate_from_physical(parameter, parameter.upper) -
         coordinate_from_physical(parameter, parameter.lower);
}

double unit_from_physical(const Parameter& parameter, double value) {
  if (value <= parameter.lower) return 0.0;
  if (value >= parameter.upper) return 1.0;
  return (coordinate_from_physical(parameter, value) -
          coordinate_from_physical(parameter, parameter.lower)) /
         coordinate_span(parameter);
}

double physical_from_unit(const Parameter& parameter, double unit) {
  if (unit <= 0.0) return parameter.lower;
  if (unit >= 1.0) return parameter.upper;
  return physical_from_coordinate(parameter, coordinate_from_physical(parameter, parameter.lower) +
                                                 unit * coordinate_span(parameter));
}

std::vector<std::size_t> free_parameters(std::span<const Parameter> parameters) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].estimate) free.push_back(i);
  }
  return free;
}

Eigen::VectorXd physical_point(std::span<const Parameter> parameters, const Eigen::VectorXd& unit) {
  Eigen::VectorXd point(static_cast<Eigen::Index>(parameters.size()));
  Eigen::Index next_free = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    point[static_cast<Eigen::Index>(i)] =
        p.estimate ? physical_from_unit(p, unit[next_free++]) : p.start;
  }
  return point;
}

Eigen::VectorXd unit_start(std::span<const Parameter> parameters) {
  const std::vector<std::size_t> free = free_parameters(parameters);
  Eigen::VectorXd unit(static_cast<Eigen::Index>(free.size()));
  for (std::size_t j = 0; j < free.size(); ++j) {
    const Parameter& p = parameters[free[j]];
    unit[static_cast<Eigen::Index>(j)] = unit_from_physical(p, p.start);
  }
  return unit;
}

}  // namespace tilth
