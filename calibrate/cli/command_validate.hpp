// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate validate FIT --data DIR`: a fitted set against new data.
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "calibrate/cli/run_session.hpp"

namespace tilth {

struct ValidateOptions {
  std::string fit;   ///< fit.json or run folder
  std::string data;  ///< folder in the soil format; every target of it is predicted
  int num_seeds = 4;
  SessionOptions session;
};

void add_validate_options(CLI::App& command, ValidateOptions& options);

/// Predicts every target of DIR at the fitted values, with intervals, on packings the fit has not
/// used, and judges by the pass mark of the fit. Writes validation.json and validation.txt.
/// @return exit code: 0 passed, 6 failed, 5 no prediction, 3 stopped
int run_validate(const ValidateOptions& options, const std::string& command_line);

}  // namespace tilth
