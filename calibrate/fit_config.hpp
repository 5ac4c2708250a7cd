// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a user may change about a soil's tables in a config file ("tilth.fit/1"), without editing
// them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibrate/soil_data.hpp"
#include "calibrate/strict_json.hpp"

namespace tilth {

/// Changes to one row of parameters.csv; what is absent stays as it is.
struct ParameterOverride {
  std::string name;
  std::optional<double> lower;
  std::optional<double> upper;
  std::optional<double> start;  ///< nominal of an estimated parameter
  std::optional<bool> log_scale;
  std::optional<bool> estimate;
  std::optional<double> value;  ///< holds the parameter at this number (estimate false, no tie)
  std::optional<std::string> tied_to;  ///< "1.5*bond_tensile_strength_Pa"; "" unties
  std::string pointer;                 ///< where in the file, for messages
};

/// The soil part of a fit config.
struct FitConfig {
  std::vector<ParameterOverride> parameters;
  /// Targets to hold out: "direct_shear", "direct_shear/cohesion_Pa" or with "/<conditionId>".
  std::vector<std::string> holdout;
};

/// Reads the keys "parameters" and "holdout" of an object that the caller has opened; the caller
/// reads its own keys ("schema", "options", ...) and calls finish().
FitConfig read_fit_config(JsonObjectReader& object);

/// Applies the changes and checks the result as parameters.csv is checked.
/// @param file      of the config, for messages
/// @param problems  unknown parameter or target (with the nearest), bounds the wrong way round,
/// ties
///                  that are unknown or circular, contradictions such as value together with start
void apply_fit_config(const FitConfig& config, const std::string& file, SoilData& soil,
                      std::vector<std::string>& problems,
                      const SoilVocabulary& vocabulary = soil_vocabulary());

}  // namespace tilth
