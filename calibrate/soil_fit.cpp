// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/soil_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calibrate/soil_files.hpp"

namespace tilth {

namespace {

/// A held parameter may have lower == upper; the fit wants a width it will never use.
void widen_empty_bounds(Parameter& parameter) {
  if (parameter.lower < parameter.upper) return;
  const double margin = parameter.start == 0.0 ? 1.0 : 0.5 * std::abs(parameter.start);
  parameter.lower = parameter.start - margin;
  parameter.upper = parameter.start + margin;
}

}  // namespace

std::vector<Target> fit_targets(const SoilData& soil) {
  const std::vector<std::string> independent = independent_groups(soil.targets);
  std::vector<Target> targets;
  for (std::size_t i = 0; i < soil.targets.size(); ++i) {
    const SoilTarget& row = soil.targets[i];
    Target target;
    target.name = label(row);
    if (!row.replicate_id.empty()) target.name += "#" + row.replicate_id;
    target.value = row.value;
    target.log_transform = row.sigma_kind == SigmaKind::log;
    target.sigma = (target.log_transform ? row.sigma : sigma_of(row)) / std::sqrt(row.weight);
    target.holdout = row.holdout;
    target.observation_group =
        independent[i].empty() ? row.observation_groups.front() : independent[i];
    target.statistic = row.test_id + "/" + row.observable_id;
    target.provenance = row.origin.provenance;
    target.source = row.origin.source + ", " + row.origin.locator;
    targets.push_back(std::move(target));
  }
  return targets;
}

std::vector<Parameter> fit_parameters(const SoilData& soil) {
  std::vector<Parameter> parameters;
  for (const SoilParameter& row : soil.parameters) {
    Parameter parameter;
    parameter.name = row.id;
    parameter.lower = row.lower;
    parameter.upper = row.upper;
    parameter.start = row.nominal;
    parameter.log_scale = row.log_scale;
    parameter.estimate = row.estimate && !row.tied_to;
    if (row.prior == PriorKind::uniform) {
      parameter.lower = std::max(row.lower, row.prior_p1);
      parameter.upper = std::min(row.upper, row.prior_p2);
      parameter.start = std::clamp(row.nominal, parameter.lower, parameter.upper);
    } else if (row.prior != PriorKind::none) {
      const bool log_normal = row.prior == PriorKind::log_normal;
      parameter.prior_mean = log_normal ? std::log(row.prior_p1) : row.prior_p1;
      parameter.prior_sigma = row.prior_p2;
    }
    if (!parameter.estimate) widen_empty_bounds(parameter);
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

Eigen::VectorXd with_ties(const std::vector<SoilParameter>& parameters, Eigen::VectorXd values) {
  const auto position = [&](const std::string& id) {
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const SoilParameter& other) { return other.id == id; });
    return static_cast<Eigen::Index>(found - parameters.begin());
  };
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    double factor = 1.0;
    const SoilParameter* at = &parameters[i];
    for (std::size_t steps = 0; at->tied_to && steps < parameters.size(); ++steps) {
      factor *= at->tied_to->factor;
      at = &parameters[static_cast<std::size_t>(position(at->tied_to->parameter_id))];
    }
    if (at != &parameters[i])
      values[static_cast<Eigen::Index>(i)] = factor * values[position(at->id)];
  }
  return values;
}

void show_ties(const std::vector<SoilParameter>& parameters, FitSummary& summary) {
  if (summary.parameters.empty()) return;
  const Eigen::VectorXd values = with_ties(parameters, summary.values());
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const std::optional<Tie>& tie = parameters[k].tied_to;
    if (!tie) continue;
    summary.parameters[k].value = values[static_cast<Eigen::Index>(k)];
    summary.parameters[k].expression = fmt::format("{}*{}", tie->factor, tie->parameter_id);
  }
}

std::string provenance_sentence(const SoilData& soil) {
  std::array<int, 4> counts{};
  int num_fitted = 0;
  int num_holdout = 0;
  for (const SoilTarget& target : soil.targets) {
    (target.holdout ? num_holdout : num_fitted) += 1;
    if (!target.holdout) ++counts[static_cast<std::size_t>(target.origin.provenance)];
  }
  std::vector<std::string> others;
  for (std::size_t i = 1; i < counts.size(); ++i) {
    if (counts[i] > 0) others.push_back(fmt::format("{} {}", counts[i], provenance_words()[i]));
  }
  return fmt::format("measured targets: {} of {} ({:.0f} %){}{}; {} held out", counts[0],
                     num_fitted, 100.0 * measured_share(soil.targets),
                     others.empty() ? "" : "; the rest: ", fmt::join(others, ", "), num_holdout);
}

}  // namespace tilth
