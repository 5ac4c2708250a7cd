// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate report RUN`: report.html from the machine files of a run folder.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>

namespace tilth {

struct ReportOptions {
  std::string run;  ///< run folder
};

void add_report_options(CLI::App& command, ReportOptions& options);
/// Writes report.html into the folder. @return exit code
int run_report(const ReportOptions& options);

/// One file that opens offline, made of fit.json, timing.json (if there) and figures/*.svg. Its first
/// line is the share of measured targets. Nothing is simulated or computed anew.
/// @throws ConfigError if fit.json is missing or no parameter card
std::string report_page(const std::filesystem::path& folder);

}  // namespace tilth
