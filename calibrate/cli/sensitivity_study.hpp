// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// From the command line to a checked sensitivity study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/command_sensitivity.hpp"
#include "calibrate/cli/virtual_test.hpp"
#include "calibrate/sensitivity.hpp"
#include "calibrate/soil_data.hpp"

namespace tilth {

struct SensitivityStudy {
  SoilData soil;
  std::vector<Parameter> parameters;
  std::vector<Target> targets;
  std::string provenance;
  std::vector<std::string> tests;  ///< chosen with --tests; empty: those of the soil's tables
  Fidelity fidelity = Fidelity::search;
  SensitivityOptions options;
  std::vector<std::filesystem::path> inputs;
};

/// Reads soil, config and, with --extend, the study that is extended. An extension keeps method,
/// levels, packings, seed and fidelity, and refuses changed inputs: its first rows are the old
/// ones.
/// @throws ConfigError with everything wrong, of all of these at once
SensitivityStudy read_study(const SensitivityCommandOptions& options);

}  // namespace tilth
