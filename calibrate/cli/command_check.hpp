// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate check DIR|FILE`: everything wrong with a data folder or config, at once.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tilth {

struct CheckOptions {
  std::string target;
};

void add_check_options(CLI::App& command, CheckOptions& options);
int run_check(const CheckOptions& options);

}  // namespace tilth
