// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate sensitivity`: which parameters move which features of the planned tests.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/cli/run_session.hpp"

namespace tilth {

/// What is absent has a default, or, with --extend, the value of the study that is extended.
struct SensitivityCommandOptions {
  std::string soil;
  std::string soil_folder;
  std::string config;
  std::vector<std::string> tests;  ///< words of chosen_tests(); empty: the tests of the soil's own tables
  std::string method;
  std::optional<int> samples;
  std::optional<int> levels;
  std::optional<int> packings;
  std::optional<std::uint64_t> seed;
  std::optional<std::size_t> max_runs;
  SessionOptions session;
  bool quick = false;
  bool extend = false;
  bool emulator = false;
};

void add_sensitivity_options(CLI::App& command, SensitivityCommandOptions& options);

/// Runs the study and writes sensitivity.json, .csv, .txt, samples.csv, figures. @return exit
/// code: 3 if a stop or the budget ended it, 5 if no feature has an index
int run_sensitivity_command(const SensitivityCommandOptions& options,
                            const std::string& command_line);

}  // namespace tilth
