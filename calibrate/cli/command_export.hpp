// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate export FIT`: the fitted set as a table or as a deck of another DEM code.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace tilth {

struct ExportOptions {
  std::string fit;
  std::string format = "json";
  std::string out;
  int num_particles = 500;
  std::uint64_t seed = 1;
};

void add_export_options(CLI::App& command, ExportOptions& options);
int run_export(const ExportOptions& options);

}  // namespace tilth
