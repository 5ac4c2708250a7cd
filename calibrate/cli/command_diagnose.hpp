// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// calibrate diagnose: where simulation and measurement disagree, and which effect is missing.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>

#include "calibrate/cli/run_session.hpp"

namespace tilth {

struct DiagnoseOptions {
  std::string soil;         ///< or "all": soils_of_all(), pooled
  std::string soil_folder;
  std::string fit;          ///< baseline values from a fit instead of an own one
  std::string tests;        ///< "mechanical", "sweep" or "all"; empty: without the sweep where the soil has other targets
  std::uint64_t seed = 1;
  bool quick = false;
  bool apply = false;
  SessionOptions session;
};

void add_diagnose_options(CLI::App& command, DiagnoseOptions& options);

/// @return exit code @throws ConfigError
int run_diagnose_command(const DiagnoseOptions& options, const std::string& command_line);

}  // namespace tilth
