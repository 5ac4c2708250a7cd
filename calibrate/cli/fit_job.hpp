// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a fit works on: soil, config and options, read and checked.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/virtual_test.hpp"
#include "calibrate/fit_options.hpp"

namespace tilth {

/// Which fit: nothing here is about folders, workers or time.
struct JobOptions {
  std::string soil;
  std::string soil_folder;  ///< --data: a folder in the soil format, instead of --soil
  std::string config;
  /// Whose targets are used: "mechanical", "sweep" or "all". Empty: all, but a preview of a soil with
  /// targets of both kinds takes the mechanical ones alone.
  std::string tests;
  std::uint64_t seed = 1;
  bool quick = false;
  bool force = false;
};

/// Adds --soil, --data, --config, --tests, --seed, --quick and --force.
void add_job_options(CLI::App& app, JobOptions& options);

/// The command line that gives the same result, without what does not influence it.
std::string job_command(const JobOptions& options);

struct FitJob {
  SoilData soil;
  FitOptions options;
  Fidelity search = Fidelity::search;
  Fidelity confirm = Fidelity::confirm;
  std::vector<std::filesystem::path> inputs;
};

/// @throws ConfigError with every problem of soil and config
FitJob read_job(const JobOptions& options);

/// @throws ConfigError with `found`, what the fit options lack, or what fit() would refuse
void refuse_bad_job(const FitJob& job, std::vector<std::string> found);

}  // namespace tilth
