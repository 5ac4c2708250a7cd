// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Effects of the catalogue as parameters of a soil: by name, at a size, as candidates.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calibrate/diagnosis/effect_scores.hpp"
#include "calibrate/diagnosis/evidence_runs.hpp"
#include "calibrate/effect_catalogue.hpp"
#include "calibrate/soil_data.hpp"

namespace tilth {

/// A size of one parameter of one effect.
struct ChosenEffect {
  std::string id;         ///< of the candidate: "bond_envelope", or "bond_envelope:bond_friction_angle_offset_rad"
  std::string parameter;  ///< "tensile_strength_shortfall"
  double value = 0.0;
};

/// "rolling_resistance=0.3", "bond_envelope:bond_friction_angle_offset_rad=0.2", "tool_adhesion=typical".
/// @throws ConfigError with every word that is no effect of the catalogue, or a size outside its bounds
std::vector<ChosenEffect> parse_effects(const std::vector<std::string>& words);

/// One way in which the model may be wrong: an effect and the parameter that is its size.
struct CandidateChoice {
  CandidateEffect candidate;     ///< for the statistics
  EffectKind kind = EffectKind::soil;
  const Effect* effect = nullptr;
  const EffectParameter* parameter = nullptr;
  EffectStep step;               ///< typical size, nuisances at their typical values
};

/// Adds all parameters of the catalogue that the soil does not have, fixed at their null values: the baseline bit for
/// bit.
void add_effect_parameters(SoilData& soil);

/// Every parameter of the catalogue that is no nuisance, in the order of the catalogue. Those that no test of the soil depends
/// on, and those the soil fits anyway, are not active.
/// @pre add_effect_parameters(soil)
std::vector<CandidateChoice> candidate_choices(const SoilData& soil);

/// Id of the candidate: the effect's for its first parameter, "effect:parameter" for the others.
std::string candidate_id(const Effect& effect, const EffectParameter& parameter);

}  // namespace tilth
