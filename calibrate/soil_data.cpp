// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/soil_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "calibrate/csv_table.hpp"
#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

template <typename Item>
const Item* find_id(const std::vector<Item>& items, std::string Item::*id,
                    std::string_view wanted) {
  for (const Item& item : items) {
    if (item.*id == wanted) return &item;
  }
  return nullptr;
}

}  // namespace

const std::vector<std::string>& provenance_words() {
  static const std::vector<std::string> words = {"measured", "literature", "derived", "synthetic"};
  return words;
}

std::optional<Provenance> provenance_from_word(std::string_view word) {
  const auto& words = provenance_words();
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) return std::nullopt;
  return static_cast<Provenance>(found - words.begin());
}

const std::vector<std::string>& sigma_kind_words() {
  static const std::vector<std::string> words = {"absolute", "relative", "floor", "log"};
  return words;
}

double sigma_of(const SoilTarget& target) {
  const double magnitude = std::abs(target.value);
  if (target.sigma_kind == SigmaKind::relative) return target.sigma * magnitude;
  if (target.sigma_kind == SigmaKind::log) return magnitude * std::sinh(target.sigma);
  return target.sigma;
}

std::string label(const SoilTarget& target) {
  const std::string name =
      fmt::format("{}/{}/{}", target.test_id, target.observable_id, target.condition_id);
  return target.x ? fmt::format("{}@{}={}", name, target.x_id, *target.x) : name;
}

std::optional<Tie> parse_tie(std::string_view text) {
  std::string word(text);
  word.erase(std::remove(word.begin(), word.end(), ' '), word.end());
  Tie tie;
  const auto star = word.find('*');
  if (star != std::string::npos) {
    const auto factor = parse_finite_number(std::string_view(word).substr(0, star));
    if (!factor) return std::nullopt;
    tie.factor = *factor;
    word.erase(0, star + 1);
  }
  const bool is_name = !word.empty() && (word[0] < '0' || word[0] > '9') &&
                       word.find_first_of("*+-/()") == std::string::npos;
  if (!is_name) return std::nullopt;
  tie.parameter_id = word;
  return tie;
}

std::vector<double> TestCondition::values(std::string_view column) const {
  const auto found = std::ranges::find(numbers, column, &ConditionNumbers::column);
  return found == numbers.end() ? std::vector<double>{} : found->values;
}

std::optional<double> TestCondition::number(std::string_view column) const {
  const std::vector<double> found = values(column);
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

const TestCondition* SoilData::condition(std::string_view condition_id) const {
  return find_id(conditions, &TestCondition::id, condition_id);
}

const SoilParameter* SoilData::parameter(std::string_view parameter_id) const {
  return find_id(parameters, &SoilParameter::id, parameter_id);
}

const StateQuantity* SoilData::quantity(std::string_view wanted) const {
  return find_id(state, &StateQuantity::quantity, wanted);
}

const MeasuredCurve* SoilData::curve(std::string_view test_id, std::string_view condition_id) const {
  const auto found = std::ranges::find_if(curves, [&](const MeasuredCurve& c) {
    return c.test_id == test_id && c.condition_id == condition_id;
  });
  return found == curves.end() ? nullptr : &*found;
}

std::size_t num_independent_observations(const std::vector<SoilTarget>& targets) {
  const std::vector<std::string> given = independent_groups(targets);
  return static_cast<std::size_t>(
      std::count_if(given.begin(), given.end(), [](const auto& group) { return !group.empty(); }));
}

std::size_t num_free_parameters(const std::vector<SoilParameter>& parameters) {
  return static_cast<std::size_t>(std::count_if(
      parameters.begin(), parameters.end(),
      [](const SoilParameter& parameter) { return parameter.estimate && !parameter.tied_to; }));
}

double measured_share(const std::vector<SoilTarget>& targets) {
  std::size_t num_fitted = 0;
  std::size_t num_measured = 0;
  for (const SoilTarget& target : targets) {
    if (target.holdout) continue;
    ++num_fitted;
    if (target.origin.provenance == Provenance::measured) ++num_measured;
  }
  return num_fitted == 0 ? 0.0
                         : static_cast<double>(num_measured) / static_cast<double>(num_fitted);
}

namespace {

/// Everything of one folder, and everything wrong with it.
SoilData read_soil(const std::filesystem::path& folder, const SoilVocabulary& vocabulary,
                   std::vector<std::string>& problems) {
  SoilData soil;
  soil.folder = folder.has_filename() ? folder : folder.parent_path();  // "soils/sand/"
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    problems.push_back(fmt::format("{}: no such folder", folder.string()));
    return soil;
  }
  read_soil_json(folder / "soil.json", soil, problems);
  soil.conditions = read_conditions(folder / "conditions.csv", vocabulary, problems);
  soil.targets = read_measurements(folder / "measurements.csv", vocabulary, problems);
  soil.parameters = read_parameters(folder / "parameters.csv", vocabulary, problems);
  soil.curves = read_curves(folder / "curves.csv", soil, vocabulary, problems);
  read_tracers(folder / "tracers.csv", vocabulary, soil, problems);
  check_conditions_of_targets(soil, vocabulary, problems);
  set_superseded_aside(soil);
  add_warnings(soil);
  return soil;
}

}  // namespace

SoilData load_soil(const std::filesystem::path& folder, const SoilVocabulary& vocabulary) {
  std::vector<std::string> problems;
  SoilData soil = read_soil(folder, vocabulary, problems);
  if (!problems.empty()) throw ConfigError(std::move(problems));
  return soil;
}

std::vector<std::string> problems_of_soil_folder(const std::filesystem::path& folder,
                                                 const SoilVocabulary& vocabulary) {
  std::vector<std::string> problems;
  read_soil(folder, vocabulary, problems);
  return problems;
}

std::optional<double> state_value(const SoilData& soil, std::string_view quantity) {
  const auto found = std::ranges::find(soil.state, quantity, &StateQuantity::quantity);
  return found == soil.state.end() ? std::nullopt : std::optional<double>(found->value);
}

std::vector<std::string> known_soils(const std::filesystem::path& data_root) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(data_root / "soils", failed)) {
    std::error_code ignored;
    const bool is_soil = std::filesystem::exists(entry.path() / "soil.json", ignored);
    if (is_soil) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::filesystem::path soil_folder(const std::filesystem::path& data_root, std::string_view name) {
  const std::vector<std::string> known = known_soils(data_root);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw ConfigError({unknown_name_sentence("soil", name, known)});
  }
  return data_root / "soils" / name;
}

}  // namespace tilth
