// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/effect_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/csv_table.hpp"
#include "calibrate/nearest_name.hpp"

namespace tilth {
namespace {

struct Place {
  const Effect* effect = nullptr;
  const EffectParameter* parameter = nullptr;
};

/// The parameter a word before "=" names; parameter null where there is none.
Place place_of(const std::string& word) {
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters)
      if (word == candidate_id(e, p) || word == e.id + ":" + p.name) return {&e, &p};
  return {};
}

std::vector<std::string> candidate_ids() {
  std::vector<std::string> ids;
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) ids.push_back(candidate_id(e, p));
  return ids;
}

Eigen::Index column_of(const SoilData& soil, const std::string& parameter) {
  const auto found = std::ranges::find(soil.parameters, parameter, &SoilParameter::id);
  return found - soil.parameters.begin();
}

bool is_touched(const Effect& effect, const SoilData& soil) {
  return std::ranges::any_of(soil.targets, [&](const SoilTarget& t) {
    return std::ranges::find(effect.tests, t.test_id) != effect.tests.end();
  });
}

}  // namespace

std::string candidate_id(const Effect& effect, const EffectParameter& parameter) {
  return &parameter == &effect.parameters.front() ? effect.id : effect.id + ":" + parameter.name;
}

std::vector<ChosenEffect> parse_effects(const std::vector<std::string>& words) {
  std::vector<ChosenEffect> chosen;
  std::vector<std::string> problems;
  for (const std::string& word : words) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    const std::string size = word.substr(std::min(word.size(), equals + 1));
    const Place place = place_of(name);
    if (!place.parameter) {
      problems.push_back("--effect " + word + ": " + unknown_name_sentence("effect", name, candidate_ids()));
      continue;
    }
    const EffectParameter& p = *place.parameter;
    const auto number = size == "typical" ? std::optional(p.typical) : parse_finite_number(size);
    if (!number || *number < p.lower || *number > p.upper) {
      problems.push_back(fmt::format("--effect {}: {} must be a number in [{:g}, {:g}] or the word typical ({:g})", word,
                                     p.name, p.lower, p.upper, p.typical));
      continue;
    }
    if (std::ranges::find(chosen, p.name, &ChosenEffect::parameter) != chosen.end())
      problems.push_back(fmt::format("--effect {}: {} is given twice", word, p.name));
    chosen.push_back({candidate_id(*place.effect, p), p.name, *number});
  }
  if (!problems.empty()) throw ConfigError(problems);
  return chosen;
}

void add_effect_parameters(SoilData& soil) {
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) {
      if (soil.parameter(p.name)) continue;
      SoilParameter added;
      added.id = p.name;
      added.lower = p.lower;
      added.upper = p.upper;
      added.nominal = p.null_value;
      added.group = "effect";
      added.role = "fixed";
      soil.parameters.push_back(added);
    }
}

std::vector<CandidateChoice> candidate_choices(const SoilData& soil) {
  std::vector<CandidateChoice> choices;
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) {
      if (p.side == EffectSide::nuisance) continue;
      CandidateChoice c;
      c.effect = &e;
      c.parameter = &p;
      c.kind = e.kind;
      c.candidate.id = candidate_id(e, p);
      c.candidate.sign = p.side == EffectSide::free ? EffectSign::free : EffectSign::positive;
      c.candidate.typical = std::abs(p.typical - p.null_value);
      c.candidate.of_interest = c.candidate.typical;
      c.candidate.common_size = e.kind == EffectKind::measurement;
      c.step.null_value = p.null_value;
      c.step.settings = {{column_of(soil, p.name), p.typical}};
      for (const EffectParameter& other : e.parameters)
        if (other.side == EffectSide::nuisance)
          c.step.settings.emplace_back(column_of(soil, other.name), other.typical);
      c.step.is_costly = e.phase == EffectPhase::setup;
      c.step.is_active = is_touched(e, soil) && !soil.parameter(p.name)->estimate;
      choices.push_back(std::move(c));
    }
  return choices;
}

}  // namespace tilth
