// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate plan`: what a fit will take; starts nothing.
#pragma once

#include <CLI/App.hpp>

#include "calibrate/cli/fit_job.hpp"

namespace tilth {

struct PlanOptions {
  JobOptions job;
  int num_threads = 0;  ///< 0: all processors
};

void add_plan_options(CLI::App& command, PlanOptions& options);

/// Prints runs per stage, core-hours from data/test_costs.csv, and the gates that can be judged
/// before a simulation. @return exit code; 2 if the fit would be refused
int run_plan(const PlanOptions& options);

}  // namespace tilth
