// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/effect_catalogue.hpp"
#include "calibrate/nearest_name.hpp"

namespace tilth {
namespace {

std::string side_words(const EffectParameter& p) {
  return p.side == EffectSide::positive ? "one-sided" : name_of(p.side);
}

void print_table(const std::vector<Effect>& effects) {
  std::cout << fmt::format("{:<29} {:<6} {:<12} {:<31} {:>6} {:>8} {:>7} {:>7}  {:<5} {:<9} {}\n",
                           "effect", "name", "kind", "parameter", "null", "typical", "lower",
                           "upper", "unit", "side", "tests");
  for (const Effect& e : effects)
    for (const EffectParameter& p : e.parameters) {
      const bool first = &p == &e.parameters.front();
      std::cout << fmt::format(
          "{:<29} {:<6} {:<12} {:<31} {:>6.3g} {:>8.3g} {:>7.3g} {:>7.3g}  {:<5} {:<9} {}\n",
          first ? e.id : "", first ? e.catalogue_name : "", first ? name_of(e.kind) : "", p.name,
          p.null_value, p.typical, p.lower, p.upper, p.unit, side_words(p),
          first ? fmt::format("{}", fmt::join(e.tests, " ")) : "");
    }
  std::cout << "Null is the baseline, bit for bit. One effect in full: calibrate effects ID. Set one: "
               "calibrate simulate ... --set parameter=value,\nor as a row of parameters.csv.\n";
}

void print_one(const Effect& e) {
  std::cout << fmt::format("{} ({}), {}, at work in {}\n\nlaw     {}\nsource  {}\nsize    {}\n"
                           "tests   {}\n\n",
                           e.id, e.catalogue_name, name_of(e.kind), name_of(e.phase), e.law,
                           e.source, e.size, fmt::join(e.tests, ", "));
  for (const EffectParameter& p : e.parameters)
    std::cout << fmt::format("{} [{}]: null {:.6g}, typical {:.6g}, in [{:.6g}, {:.6g}], {}\n",
                             p.name, p.unit, p.null_value, p.typical, p.lower, p.upper,
                             side_words(p));
}

}  // namespace

void add_effects_options(CLI::App& command, EffectsOptions& o) {
  command.add_option("id", o.id, "one effect in full");
  command.add_flag("--json", o.json, "the catalogue as JSON (schema tilth.effects/1)");
}

int run_effects(const EffectsOptions& o) {
  const std::vector<Effect>& effects = effect_catalogue();
  if (o.json) {
    std::cout << effects_json;
  } else if (o.id.empty()) {
    print_table(effects);
  } else if (const Effect* effect = find_effect(effects, o.id)) {
    print_one(*effect);
  } else {
    std::vector<std::string> ids;
    for (const Effect& e : effects) ids.push_back(e.id);
    throw ConfigError({unknown_name_sentence("effect", o.id, ids)});
  }
  return exit_done;
}

}  // namespace tilth
