// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "calibrate/config_error.hpp"
#include "calibrate/effect_catalogue.hpp"
#include "calibrate/soil_vocabulary.hpp"
#include "calibrate/strict_json.hpp"

namespace tilth {
namespace {

// In the order of the enumerations.
constexpr std::array<const char*, 6> kinds = {"soil",  "tool",      "boundary",
                                              "setup", "numerical", "measurement"};
constexpr std::array<const char*, 4> phases = {"preparation", "test", "setup", "measurement"};
constexpr std::array<const char*, 3> sides = {"positive", "free", "nuisance"};

template <typename Enum, std::size_t N>
Enum read_word(JsonObjectReader& entry, std::string_view key,
               const std::array<const char*, N>& words) {
  const std::vector<std::string> allowed(words.begin(), words.end());
  const auto word = entry.required_choice(key, allowed);
  const auto found = std::ranges::find(allowed, word.value_or(allowed.front()));
  return static_cast<Enum>(found - allowed.begin());
}

EffectParameter read_parameter(JsonObjectReader& entry) {
  EffectParameter p;
  p.name = entry.required_text("name").value_or("");
  p.null_value = entry.required_number("null").value_or(0.0);
  p.typical = entry.required_number("typical").value_or(0.0);
  p.lower = entry.required_number("lower").value_or(0.0);
  p.upper = entry.required_number("upper").value_or(0.0);
  p.unit = entry.required_text("unit").value_or("");
  p.side = read_word<EffectSide>(entry, "side", sides);
  entry.finish();
  std::string reason;
  if (!has_si_name(p.name, &reason)) entry.problem("name", reason);
  for (const double x : {p.null_value, p.typical})
    if (!(x >= p.lower && x <= p.upper))
      entry.problem("", fmt::format("{}: null and typical must be in [lower, upper] = [{}, {}]",
                                    p.name, p.lower, p.upper));
  if (p.side == EffectSide::positive && p.lower < p.null_value)
    entry.problem("side", p.name + ": a positive effect has no room below its null value");
  return p;
}

Effect read_effect(JsonObjectReader& entry) {
  Effect e;
  e.id = entry.required_text("id").value_or("");
  e.catalogue_name = entry.required_text("catalogue_name").value_or("");
  e.kind = read_word<EffectKind>(entry, "kind", kinds);
  e.phase = read_word<EffectPhase>(entry, "phase", phases);
  e.law = entry.required_text("law").value_or("");
  e.source = entry.required_text("source").value_or("");
  e.size = entry.required_text("size").value_or("");
  e.tests = entry.texts("tests");
  for (JsonObjectReader& p : entry.objects("parameters")) e.parameters.push_back(read_parameter(p));
  entry.finish();
  if (e.tests.empty()) entry.problem("tests", "must name at least one test");
  if (e.parameters.empty()) entry.problem("parameters", "must have at least one");
  return e;
}

void check_unique(const std::vector<Effect>& effects, JsonObjectReader& root) {
  std::set<std::string> seen;
  for (const Effect& e : effects) {
    if (!seen.insert(e.id).second) root.problem("effects", "'" + e.id + "' occurs twice");
    for (const EffectParameter& p : e.parameters)
      if (!seen.insert("parameter " + p.name).second)
        root.problem("effects", "parameter '" + p.name + "' occurs twice");
  }
}

std::vector<Effect> built_in() {
  std::vector<std::string> problems;
  std::vector<Effect> effects = read_effects(effects_json, "data/effects.json", problems);
  if (!problems.empty()) throw ConfigError(problems);
  return effects;
}

}  // namespace

const char* name_of(EffectKind kind) { return kinds[static_cast<std::size_t>(kind)]; }
const char* name_of(EffectPhase phase) { return phases[static_cast<std::size_t>(phase)]; }
const char* name_of(EffectSide side) { return sides[static_cast<std::size_t>(side)]; }

std::vector<Effect> read_effects(std::string_view json, const std::filesystem::path& file,
                                 std::vector<std::string>& problems) {
  const JsonDocument document = parse_json(json, file, problems);
  JsonObjectReader root(document, problems);
  root.schema("tilth.effects/1");
  std::vector<Effect> effects;
  for (JsonObjectReader& entry : root.objects("effects")) effects.push_back(read_effect(entry));
  check_unique(effects, root);
  root.finish();
  return effects;
}

const std::vector<Effect>& effect_catalogue() {
  static const std::vector<Effect> effects = built_in();
  return effects;
}

const Effect* find_effect(const std::vector<Effect>& effects, std::string_view id) {
  const auto found = std::ranges::find(effects, id, &Effect::id);
  return found == effects.end() ? nullptr : &*found;
}

}  // namespace tilth
