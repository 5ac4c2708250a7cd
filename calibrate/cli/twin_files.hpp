// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The folder of a twin, and its sealed truth.
#pragma once

#include <filesystem>
#include <string>

#include "calibrate/cli/twin_data.hpp"

namespace tilth {

/// soil.json of the twin: the state of the soil it is of, everything marked synthetic.
std::string twin_soil_json(const SoilData& soil, const std::string& id);

/// What was hidden, schema "tilth.truth/1": the only place where it is written.
std::string twin_truth_json(const TwinData& twin, const TwinPlan& plan, const std::string& source_soil,
                            const std::string& command);

/// A truth read back, for whoever scores a diagnosis.
struct TwinTruthFile {
  std::vector<ChosenEffect> effects;
  std::vector<std::pair<std::string, double>> parameters;
};
/// @throws ConfigError if it is no such file
TwinTruthFile read_twin_truth(const std::filesystem::path& file);

}  // namespace tilth
