// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// calibrate twin: measurements with a hidden truth, to try whether a diagnosis finds it.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace tilth {

struct TwinOptions {
  std::string soil;
  std::string soil_folder;
  std::vector<std::string> effects;
  std::vector<std::string> tests;  ///< empty: laboratory
  double noise = 0.10;
  double rig_noise = 0.03;
  int num_replicates = 5;
  std::uint64_t seed = 1;
  bool quick = false;
  std::string out;
  std::string truth;
  int num_threads = 0;
};

void add_twin_options(CLI::App& command, TwinOptions& options);

/// @return exit code @throws ConfigError
int run_twin_command(const TwinOptions& options);

}  // namespace tilth
