// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/targets.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>

namespace tilth {
namespace {

void check_target(const Target& target, std::vector<std::string>& found) {
  if (!std::isfinite(target.value)) {
    found.push_back(fmt::format("target {}: value = {} must be finite", target.name, target.value));
  } else if (target.log_transform && target.value <= 0.0) {
    found.push_back(fmt::format("target {}: value = {} must be positive to take its logarithm",
                                target.name, target.value));
  }
  if (!(std::isfinite(target.sigma) && target.sigma > 0.0)) {
    found.push_back(fmt::format("target {}: sigma = {} must be finite and positive", target.name,
                                target.sigma));
  }
}

}  // namespace

std::string_view to_string(Provenance provenance) {
  switch (provenance) {
    case Provenance::measured:
      return "measured";
    case Provenance::literature:
      return "literature";
    case Provenance::derived:
      return "derived";
    case Provenance::synthetic:
      return "synthetic";
  }
  return "unknown";
}

std::vector<std::string> problems(std::span<const Target> targets) {
  std::vector<std::string> found;
  std::set<std::string> names;
  for (const Target& target : targets) {
    if (target.name.empty()) found.emplace_back("a target has no name");
    if (!names.insert(target.name).second) {
      found.push_back(fmt::format("target {}: the name is used twice", target.name));
    }
    check_target(target, found);
  }
  if (fitted_targets(targets).empty()) {
    found.emplace_back("no target is to be fitted: at least one must not be a hold-out");
  }
  return found;
}

double transformed(const Target& target, double value) {
  if (!target.log_transform) return value;
  return value > 0.0 ? std::log(value) : std::numeric_limits<double>::quiet_NaN();
}

double untransformed(const Target& target, double transformed_value) {
  return target.log_transform ? std::exp(transformed_value) : transformed_value;
}

std::vector<std::size_t> fitted_targets(std::span<const Target> targets) {
  std::vector<std::size_t> fitted;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (!targets[k].holdout) fitted.push_back(k);
  }
  return fitted;
}

std::size_t num_independent_observations(std::span<const Target> targets) {
  std::set<std::string> groups;
  for (const Target& target : targets) {
    if (target.holdout) continue;
    groups.insert(target.observation_group.empty() ? target.name : target.observation_group);
  }
  return groups.size();
}

double total_sigma(double sigma, double seed_variance, int num_seeds, double bias_variance) {
  return std::sqrt(sigma * sigma + seed_variance / num_seeds + bias_variance);
}

}  // namespace tilth
