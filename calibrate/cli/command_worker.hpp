// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate worker`: simulations on request, for a program that started this one.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace tilth {

struct WorkerOptions {
  int max_lanes = 0;
};

void add_worker_options(CLI::App& command, WorkerOptions& options);
int run_worker_command(const WorkerOptions& options);

/// The command line that starts a worker of this very program.
std::vector<std::string> worker_command(int max_lanes);

}  // namespace tilth
