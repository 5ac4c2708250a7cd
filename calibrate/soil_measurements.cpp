// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// conditions.csv and measurements.csv.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "calibrate/csv_table.hpp"
#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

/// The numbers of one cell, each inside what is physically usual.
std::vector<double> usual(CsvRowReader& row, const KnownConditionColumn& column) {
  std::vector<double> values;
  if (column.takes_list) values = row.optional_numbers(column.name);
  else if (const auto number = row.optional_number(column.name)) values = {*number};
  for (const double value : values) {
    if (value >= column.plausible_lower && value <= column.plausible_upper) continue;
    row.problem(
        fmt::format("{} = {}: must be in [{}, {}]{}", column.name, value, column.plausible_lower,
                    column.plausible_upper,
                    unit_hint(column.name, value, column.plausible_lower, column.plausible_upper)));
  }
  return values;
}

TestCondition read_condition(CsvRowReader& row, const SoilVocabulary& vocabulary) {
  TestCondition condition;
  condition.line = row.line();
  condition.id = row.text("conditionId");
  for (const KnownConditionColumn& column : vocabulary.condition_columns) {
    std::vector<double> values = usual(row, column);
    if (!values.empty()) condition.numbers.push_back({column.name, std::move(values)});
  }
  condition.note = row.optional_text("note");
  return condition;
}

std::vector<std::string> split_groups(const std::string& text) {
  std::vector<std::string> groups;
  std::istringstream stream(text);
  for (std::string group; std::getline(stream, group, ';');) {
    group.erase(std::remove(group.begin(), group.end(), ' '), group.end());
    if (!group.empty()) groups.push_back(group);
  }
  return groups;
}

void read_sigma(CsvRowReader& row, SoilTarget& target) {
  const auto sigma = row.number("sigma");
  target.sigma = sigma.value_or(0.0);
  if (sigma && !(*sigma > 0.0)) row.problem(fmt::format("sigma = {}: must be > 0", *sigma));
  const std::string kind = row.choice("sigma_kind", "sigma_kind", sigma_kind_words());
  const auto& kinds = sigma_kind_words();
  const auto found = std::find(kinds.begin(), kinds.end(), kind);
  if (found != kinds.end()) target.sigma_kind = static_cast<SigmaKind>(found - kinds.begin());
  const bool scaled_by_value =
      target.sigma_kind == SigmaKind::log || target.sigma_kind == SigmaKind::relative;
  if (scaled_by_value && !(target.value > 0.0)) {
    row.problem(fmt::format("value = {}: must be > 0 with sigma_kind {}", target.value, kind));
  }
}

void check_value(CsvRowReader& row, const SoilTarget& target, const KnownObservable& known) {
  if (target.value < 0.0 && known.plausible_lower >= 0.0) {
    row.problem(fmt::format("{} = {}: must not be negative (compression is positive)",
                            target.observable_id, target.value));
    return;
  }
  const bool curve_point = target.x.has_value();  // a curve may begin at zero
  const bool too_small = target.value < known.plausible_lower && !curve_point &&
                         !(target.value == 0.0 && target.observable_id.ends_with("cohesion_Pa"));
  if (!too_small && target.value <= known.plausible_upper) return;
  row.problem(fmt::format(
      "{} = {:.6g}: not plausible for soil, must be in [{:.6g}, {:.6g}]{}", target.observable_id,
      target.value, known.plausible_lower, known.plausible_upper,
      unit_hint(target.observable_id, target.value, known.plausible_lower, known.plausible_upper)));
}

void read_origin(CsvRowReader& row, SoilTarget& target) {
  const std::string word = row.choice("provenance", "provenance", provenance_words());
  target.origin.provenance = provenance_from_word(word).value_or(Provenance::synthetic);
  target.origin.source = row.text("source");
  target.origin.locator = row.text("locator");
}

void read_x(CsvRowReader& row, SoilTarget& target) {
  target.x_id = row.optional_text("xId");
  target.x = row.optional_number("x");
  if (target.x_id.empty() == target.x.has_value()) {
    row.problem("xId and x belong together: give both or neither");
  }
  std::string reason;
  if (!has_si_name(target.x_id, &reason)) row.problem("xId " + reason);
}

/// Empty when test or observable are unknown (reported).
const KnownObservable* read_names(CsvRowReader& row, SoilTarget& target,
                                  const SoilVocabulary& vocabulary) {
  target.test_id = row.choice("testId", "testId", vocabulary.test_ids());
  target.condition_id = row.text("conditionId");
  if (target.test_id.empty()) return nullptr;
  target.observable_id = row.choice("observableId", "observableId of " + target.test_id,
                                    vocabulary.observable_ids(target.test_id));
  return vocabulary.observable(target.test_id, target.observable_id);
}

/// Reads every cell even when an early one is wrong, so that all mistakes of a row are listed.
std::optional<SoilTarget> read_target(CsvRowReader& row, const SoilVocabulary& vocabulary) {
  SoilTarget target;
  target.line = row.line();
  const KnownObservable* known = read_names(row, target, vocabulary);
  read_x(row, target);
  const auto value = row.number("value");
  target.value = value.value_or(1.0);
  read_sigma(row, target);
  target.replicate_id = row.optional_text("replicateId");
  target.weight = row.optional_number("weight").value_or(1.0);
  if (!(target.weight > 0.0)) {
    row.problem(fmt::format("weight = {}: must be > 0; to keep a row out of the fit set holdout 1",
                            target.weight));
  }
  target.holdout = row.flag("holdout").value_or(false);
  read_origin(row, target);
  target.observation_groups = split_groups(row.optional_text("observation_group"));
  if (known == nullptr || !value) return std::nullopt;
  if (target.observation_groups.empty()) target.observation_groups.push_back(label(target));
  check_value(row, target, *known);
  return target;
}

}  // namespace

std::vector<TestCondition> read_conditions(const std::filesystem::path& file,
                                           const SoilVocabulary& vocabulary,
                                           std::vector<std::string>& problems) {
  CsvColumns columns{{"conditionId"}, {"note"}};
  for (const KnownConditionColumn& column : vocabulary.condition_columns)
    columns.optional.push_back(column.name);
  const CsvTable table = read_csv(file, columns, problems);
  std::vector<TestCondition> conditions;
  std::set<std::string> seen;
  for (const CsvRow& record : table.rows) {
    CsvRowReader row(table, record, problems);
    conditions.push_back(read_condition(row, vocabulary));
    const std::string& id = conditions.back().id;
    if (!id.empty() && !seen.insert(id).second) {
      row.problem(fmt::format("conditionId '{}' occurs twice", id));
    }
  }
  return conditions;
}

std::vector<SoilTarget> read_measurements(const std::filesystem::path& file,
                                          const SoilVocabulary& vocabulary,
                                          std::vector<std::string>& problems) {
  const CsvColumns columns{{"testId", "observableId", "conditionId", "value", "sigma", "sigma_kind",
                            "holdout", "provenance", "source", "locator"},
                           {"xId", "x", "replicateId", "weight", "observation_group"}};
  const CsvTable table = read_csv(file, columns, problems);
  std::vector<SoilTarget> targets;
  for (const CsvRow& record : table.rows) {
    CsvRowReader row(table, record, problems);
    if (auto target = read_target(row, vocabulary)) targets.push_back(std::move(*target));
  }
  return targets;
}

}  // namespace tilth
