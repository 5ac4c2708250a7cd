// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_report.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/run_folder.hpp"

namespace tilth {

void add_report_options(CLI::App& command, ReportOptions& o) {
  command.add_option("run", o.run, "run folder")->required();
}

int run_report(const ReportOptions& o) {
  const std::filesystem::path file = std::filesystem::path(o.run) / "report.html";
  write_file(file, report_page(o.run));
  std::cout << "report: " << file.string() << '\n';
  return exit_done;
}

}  // namespace tilth
