// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// calibrate scale: how large may the particles be before tracers go elsewhere?
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/cli/run_session.hpp"

namespace tilth {

struct ScaleCommandOptions {
  std::string soil;         ///< or "all": soils_of_all()
  std::string soil_folder;
  std::string fit;
  std::vector<double> radii_mm;
  std::vector<std::string> settings;
  std::vector<std::string> variants;  ///< "NAME:key=value:key=value"
  int num_packings = 0;     ///< 0: 3, or 2 with --quick
  double within_percent = 15.0;
  std::uint64_t seed = 1;
  bool quick = false;
  SessionOptions session;
};

void add_scale_options(CLI::App& command, ScaleCommandOptions& options);

/// @return exit code @throws ConfigError
int run_scale_command(const ScaleCommandOptions& options, const std::string& command_line);

}  // namespace tilth
