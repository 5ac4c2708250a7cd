// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// sensitivity.json: written after a study, read when it is extended.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "calibrate/cli/sensitivity_study.hpp"
#include "calibrate/sensitivity_report.hpp"

namespace tilth {

/// What the file says beside the study. `reproduction` is the only part that differs between runs
/// of the same study; what a run cost is in timing.json.
struct SensitivityCardContext {
  SensitivityContext report;
  std::string soil_id;
  std::string command;
  std::vector<std::filesystem::path> inputs;
  std::vector<Parameter> parameters;
  std::vector<std::string> tests;  ///< of --tests, or empty
};

/// The file as JSON text, schema "tilth.sensitivity/1".
std::string sensitivity_json(const SensitivitySummary& summary,
                             const SensitivityCardContext& context);

/// config.json: what makes one study different from another, for --resume.
std::string sensitivity_config_json(const SensitivityStudy& study);

/// What an extension must keep.
struct SavedStudy {
  std::string soil_id;
  std::string method;  ///< word of to_string(SensitivityMethod)
  int num_rows = 0;    ///< asked for, finished or not
  int levels = 4;
  int num_packings = 0;
  std::uint64_t seed = 0;
  bool preview = false;
  std::vector<std::string> tests;
  std::vector<std::pair<std::string, std::string>> inputs;  ///< file name, SHA-256
};

/// Reads <run folder>/sensitivity.json. @throws ConfigError with every problem
SavedStudy read_saved_study(const std::filesystem::path& run_folder);

}  // namespace tilth
