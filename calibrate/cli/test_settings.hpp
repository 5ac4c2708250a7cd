// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a virtual test is run with: the material of a soil or a fit, and key=value of the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibrate/cli/virtual_test.hpp"

namespace tilth {

struct MaterialSource {
  std::string soil;         ///< under data/soils
  std::string soil_folder;  ///< --data, instead
  std::string fit;          ///< fit.json or run folder: its fitted values instead of the nominal ones
};

/// The soil; nothing for a fit of a soil that is not under data/soils when no folder is named. @throws ConfigError
std::optional<SoilData> soil_of(const MaterialSource& source);

/// The nominal or fitted material; takes what the config needs from the state of the soil, where there is a soil.
SoilMaterial starting_material(const MaterialSource& source, TestConfig& config,
                               std::vector<std::string>& problems);

/// Sets key=value in the test's config or in the material; every mistake is listed, behind `option`.
void apply_settings(const std::string& option, const std::vector<std::string>& settings,
                    TestConfig& config, SoilMaterial& material, std::vector<std::string>& problems);

/// Ranges and contradictions of both. @throws ConfigError listing `found` and them, if there are any
void refuse_bad_test(std::vector<std::string> found, const TestConfig& config,
                     const SoilMaterial& material);

}  // namespace tilth
