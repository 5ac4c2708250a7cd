// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate features`: rows of measurements.csv from measured curves.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tilth {

struct FeaturesOptions {
  std::string soil;
  std::string soil_folder;
  std::vector<std::string> fitted;
  std::string source = "measured curves of this folder";
  std::string out;  ///< empty: standard output
};

void add_features_options(CLI::App& command, FeaturesOptions& options);

int run_features(const FeaturesOptions& options);

}  // namespace tilth
