// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The catalogue of candidate missing effects, data/effects.json: the one place where they are listed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tilth {

enum class EffectKind { soil, tool, boundary, setup, numerical, measurement };

/// When an effect is at work.
enum class EffectPhase {
  preparation,  ///< would loosen a specimen: switched on when its density is reached, then re-equilibrated
  test,
  setup,        ///< changes how the test is set up
  measurement   ///< changes curves and features after the test
};

/// Where the effect lies of its null value.
enum class EffectSide { positive, free, nuisance };  ///< nuisance: no effect while the others are null

struct EffectParameter {
  std::string name;         ///< of the material, ends in its SI unit
  double null_value = 0.0;  ///< the baseline, bit for bit
  double typical = 0.0;     ///< size worth finding
  double lower = 0.0, upper = 0.0;
  std::string unit;  ///< "1" where there is none
  EffectSide side = EffectSide::positive;
};

struct Effect {
  std::string id;
  std::string catalogue_name;  ///< "ROLL", "CAP", ...
  EffectKind kind = EffectKind::soil;
  EffectPhase phase = EffectPhase::test;
  std::string law;
  std::string source;
  std::string size;  ///< where typical comes from
  std::vector<std::string> tests;
  std::vector<EffectParameter> parameters;
};

const char* name_of(EffectKind kind);
const char* name_of(EffectPhase phase);
const char* name_of(EffectSide side);

/// The catalogue of this version, read once from the text built into the program.
/// @throws ConfigError if that text is damaged
const std::vector<Effect>& effect_catalogue();

/// The same from any text. @param problems gets a sentence for every unknown key, wrong type, repeated id or
/// parameter, name without SI unit, bounds that exclude null or typical value, unknown kind, phase or side
std::vector<Effect> read_effects(std::string_view json, const std::filesystem::path& file,
                                 std::vector<std::string>& problems);

/// Effect of that id, or nullptr.
const Effect* find_effect(const std::vector<Effect>& effects, std::string_view id);

/// data/effects.json as it was when the program was built.
extern const std::string_view effects_json;

}  // namespace tilth
