// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The main job: `calibrate --soil X`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "calibrate/cli/run_session.hpp"

namespace tilth {

struct FitCommandOptions {
  std::string soil;
  std::string soil_folder;  ///< --data: a folder in the soil format, instead of --soil
  std::string config;
  SessionOptions session;
  std::uint64_t seed = 1;
  std::size_t max_runs = 0;  ///< parameter sets times packings; 0: as the fit options say
  bool quick = false;
  bool force = false;
};

/// Adds the options of the main job to the program itself.
void add_fit_options(CLI::App& app, FitCommandOptions& options);

/// Runs the fit and writes the run folder. @return exit code
int run_fit(const FitCommandOptions& options, const std::string& command_line);

}  // namespace tilth
