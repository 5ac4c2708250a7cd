// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// calibrate --soil all: one fit after the other, then the comparison.
#pragma once

#include <string>

#include "calibrate/cli/command_fit.hpp"

namespace tilth {

/// Fits the soils that are fitted with the same parameters, each into OUT/<soil> as `--soil <soil>` would, then draws the
/// standard sweep through all of them and writes OUT/comparison.txt, comparison.json and figures/comparison.svg. --resume goes on
/// where it stopped; --max-walltime is for all together.
/// @return the worst exit code of the fits: bad input, budget, failed runs, unreachable, hold-out, done
/// @throws ConfigError with the problems of all soils, before anything runs
int run_fit_of_all_soils(const FitCommandOptions& options, const std::string& command_line);

}  // namespace tilth
