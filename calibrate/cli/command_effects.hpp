// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate effects`: the catalogue of candidate missing effects.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tilth {

struct EffectsOptions {
  std::string id;     ///< empty: all, one line per parameter
  bool json = false;  ///< data/effects.json as built in
};

void add_effects_options(CLI::App& command, EffectsOptions& options);

/// @throws ConfigError naming the nearest effect where there is none of that id
int run_effects(const EffectsOptions& options);

}  // namespace tilth
