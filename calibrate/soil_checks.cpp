// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Checks and rules across the files of a soil folder.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

/// What the row lacks for this observable; empty when it has all.
std::string unmet_need(const TestCondition& condition, const KnownObservable& observable) {
  for (const std::string& column : observable.needed_columns)
    if (condition.values(column).empty()) return column;
  const std::vector<double> normal = condition.values("normal_stress_Pa");
  const std::set<double> stresses(normal.begin(), normal.end());
  const std::vector<double> cell = condition.values("cell_pressure_Pa");
  const std::set<double> cells(cell.begin(), cell.end());
  const auto from = condition.number("load_from_stress_Pa");
  const auto to = condition.number("load_to_stress_Pa");
  const auto back = condition.number("unload_to_stress_Pa");
  switch (observable.need) {
    case ConditionNeed::none:
      return "";
    case ConditionNeed::one_normal_stress:
      return stresses.size() == 1 ? "" : "normal_stress_Pa with one number";
    case ConditionNeed::three_normal_stresses:
      return stresses.size() >= 3 ? ""
                                  : "normal_stress_Pa with at least three, as 10000;20000;40000";
    case ConditionNeed::one_cell_pressure:
      return cells.size() == 1 ? "" : "cell_pressure_Pa with one number";
    case ConditionNeed::two_cell_pressures:
      return cells.size() >= 2 ? "" : "cell_pressure_Pa with at least two, as 50000;100000;200000";
    case ConditionNeed::load_stresses:
      return from && to && *from < *to ? "" : "load_from_stress_Pa below load_to_stress_Pa";
    case ConditionNeed::unload_stresses:
      return to && back && *back < *to ? "" : "unload_to_stress_Pa below load_to_stress_Pa";
  }
  return "";
}

using Key = std::tuple<std::string, std::string, std::string, std::string, double>;

Key key_of(const SoilTarget& target) {
  return {target.test_id, target.observable_id, target.condition_id, target.x_id,
          target.x.value_or(0.0)};
}

bool try_to_place(std::size_t target, const std::vector<SoilTarget>& targets,
                  std::map<std::string, std::size_t>& holder, std::set<std::string>& visited) {
  for (const std::string& group : targets[target].observation_groups) {
    if (!visited.insert(group).second) continue;
    const auto taken = holder.find(group);
    if (taken == holder.end() || try_to_place(taken->second, targets, holder, visited)) {
      holder[group] = target;
      return true;
    }
  }
  return false;
}

void warn_of_stale_rows(SoilData& soil) {
  for (const SupersededTarget& old : soil.superseded) {
    for (const SoilTarget& target : soil.targets) {
      const auto& groups = target.observation_groups;
      const bool related = std::any_of(groups.begin(), groups.end(), [&](const auto& group) {
        const auto& others = old.target.observation_groups;
        return std::find(others.begin(), others.end(), group) != others.end();
      });
      const bool same_number = key_of(target) == key_of(old.target);
      if (related && !same_number && target.origin.provenance == Provenance::derived) {
        soil.warnings.push_back(
            fmt::format("measurements.csv:{}: {} is derived and shares an observation group with "
                        "the superseded "
                        "line {}: compute it anew from the better number, or remove it",
                        target.line, label(target), old.target.line));
      }
    }
  }
}

}  // namespace

void check_conditions_of_targets(const SoilData& soil, const SoilVocabulary& vocabulary,
                                 std::vector<std::string>& problems) {
  const std::string file = (soil.folder / "measurements.csv").string();
  std::vector<std::string> known;
  for (const TestCondition& condition : soil.conditions) known.push_back(condition.id);
  std::map<std::tuple<Key, std::string, Provenance>, std::size_t> seen;
  for (const SoilTarget& target : soil.targets) {
    const std::string where = fmt::format("{}:{}: ", file, target.line);
    const auto identity = std::tuple(key_of(target), target.replicate_id, target.origin.provenance);
    const auto [first, is_new] = seen.emplace(identity, target.line);
    if (!is_new) {
      problems.push_back(where + fmt::format("the same as line {} ({}, replicate '{}'): replicates "
                                             "need different replicateId",
                                             first->second, label(target), target.replicate_id));
    }
    if (target.condition_id.empty()) continue;
    const TestCondition* condition = soil.condition(target.condition_id);
    if (condition == nullptr) {
      problems.push_back(where + unknown_name_sentence("conditionId", target.condition_id, known) +
                         " (conditions.csv)");
      continue;
    }
    const KnownObservable* observable = vocabulary.observable(target.test_id, target.observable_id);
    const std::string need = observable == nullptr ? "" : unmet_need(*condition, *observable);
    if (need.empty()) continue;
    problems.push_back(where + fmt::format("{} needs {} in condition '{}' (conditions.csv:{})",
                                           target.observable_id, need, condition->id,
                                           condition->line));
  }
}

void set_superseded_aside(SoilData& soil) {
  std::map<Key, const SoilTarget*> best;
  for (const SoilTarget& target : soil.targets) {
    const auto [entry, is_new] = best.emplace(key_of(target), &target);
    if (!is_new && target.origin.provenance < entry->second->origin.provenance) {
      entry->second = &target;
    }
  }
  std::vector<SoilTarget> kept;
  for (const SoilTarget& target : soil.targets) {
    const SoilTarget& winner = *best.at(key_of(target));
    if (winner.origin.provenance == target.origin.provenance) {
      kept.push_back(target);
      continue;
    }
    soil.superseded.push_back(
        {target, fmt::format("measurements.csv:{}: {} ({}) is superseded by line {} ({})",
                             target.line, label(target), to_string(target.origin.provenance),
                             winner.line, to_string(winner.origin.provenance))});
  }
  soil.targets = std::move(kept);
}

std::vector<std::string> independent_groups(const std::vector<SoilTarget>& targets) {
  std::map<std::string, std::size_t> holder;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    std::set<std::string> visited;
    if (!targets[i].holdout) try_to_place(i, targets, holder, visited);
  }
  std::vector<std::string> given(targets.size());
  for (const auto& [group, target] : holder) given[target] = group;
  return given;
}

void add_warnings(SoilData& soil) {
  const std::size_t observations = num_independent_observations(soil.targets);
  const std::size_t free_parameters = num_free_parameters(soil.parameters);
  if (observations < free_parameters) {
    soil.warnings.push_back(fmt::format(
        "{} free parameters and only {} independent observations: the fit is under-determined; fix "
        "parameters or add tests (numbers of one observation_group count once)",
        free_parameters, observations));
  }
  if (measured_share(soil.targets) == 0.0) {
    soil.warnings.push_back("no target of the fit is measured");
  }
  const std::string folder_name = soil.folder.filename().string();
  if (!folder_name.empty() && soil.id != folder_name) {
    soil.warnings.push_back(
        fmt::format("soil.json: id '{}' differs from the folder name '{}'", soil.id, folder_name));
  }
  for (const SupersededTarget& old : soil.superseded) soil.warnings.push_back(old.reason);
  warn_of_stale_rows(soil);
}

}  // namespace tilth
