// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate simulate`: one virtual test.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace tilth {

struct SimulateOptions {
  std::string experiment;
  std::string soil;
  std::string soil_folder;
  std::string fit;
  std::vector<std::string> settings;  ///< key=value
  std::string out;
  std::uint64_t seed = 1;
  int num_seeds = 1;
  int num_threads = 0;
  bool quick = false;
  bool vtk = false;                  ///< sweep_tillage: a ParaView time series
  std::string tool;                  ///< sweep_tillage: an STL file instead of the parametric sweep
  double tool_metres_per_unit = 1e-3;
};

void add_simulate_options(CLI::App& command, SimulateOptions& options);
int run_simulate(const SimulateOptions& options, const std::string& command_line);

}  // namespace tilth
