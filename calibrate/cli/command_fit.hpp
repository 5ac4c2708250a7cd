// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The main job: `calibrate --soil X`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "calibrate/cli/fit_job.hpp"
#include "calibrate/cli/run_session.hpp"

namespace tilth {

struct FitCommandOptions {
  JobOptions job;
  SessionOptions session;
  std::size_t max_runs = 0;  ///< parameter sets times packings; 0: as the fit options say
};

/// Adds the options of the main job to the program itself.
void add_fit_options(CLI::App& app, FitCommandOptions& options);

/// Runs the fit and writes the run folder. @return exit code
int run_fit(const FitCommandOptions& options, const std::string& command_line);

}  // namespace tilth
