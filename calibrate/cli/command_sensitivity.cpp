// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_sensitivity.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/interrupt.hpp"
#include "calibrate/cli/progress_display.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/sensitivity_card.hpp"
#include "calibrate/cli/sensitivity_figures.hpp"
#include "calibrate/cli/sensitivity_study.hpp"

namespace tilth {
namespace {

/// The one place where a study gets its simulator: a store of runs goes around this one. A test that
/// fails takes no other test's features with it.
Simulator study_simulator(const SensitivityStudy& study, const RunContext& context) {
  return dem_simulator(study.soil, study.fidelity, context, TargetScope::all,
                       FailedTest::leaves_others);
}

int thread_count(int wanted) {
  return wanted > 0 ? wanted
                    : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void write_results(const SensitivityStudy& study, const SensitivitySummary& summary,
                   const SensitivityCardContext& card, const std::filesystem::path& folder) {
  write_file(folder / "sensitivity.json", sensitivity_json(summary, card));
  write_file(folder / "sensitivity.csv", sensitivity_csv(summary, card.report));
  write_file(folder / "sensitivity.txt", sensitivity_report_text(summary, card.report));
  write_file(folder / "samples.csv", samples_csv(summary, study.parameters, card.report));
  for (const std::string& why : draw_sensitivity(summary, card.report, folder))
    std::cerr << "no figure: " << why << '\n';
}

int exit_code_of(const SensitivitySummary& summary) {
  if (summary.end != SensitivityEnd::completed) return exit_budget;
  return summary.has_indices() ? exit_done : exit_failed_runs;
}

}  // namespace

void add_sensitivity_options(CLI::App& command, SensitivityCommandOptions& o) {
  CLI::Option* soil = command.add_option("--soil", o.soil, "soil under data/soils");
  command.add_option("--data", o.soil_folder, "a folder in the soil format, instead of --soil")
      ->excludes(soil);
  command.add_option("--method", o.method, "morris or sobol");
  command.add_option("--samples", o.samples,
                     "trajectories (morris) or rows (sobol); powers of two are spread best");
  command.add_flag("--extend", o.extend,
                   "the study in --out with twice its samples, or with --samples");
  command.add_flag("--emulator", o.emulator,
                   "sobol from an emulator of single points: cheap, and labelled as such");
  command.add_option("--levels", o.levels, "morris: levels of the grid, even (default 4)");
  command.add_option("--packings", o.packings, "packings the rows are spread over (default 8)");
  command.add_option("--config", o.config, "changes to parameters and targets (tilth.fit/1)");
  command.add_option("--out", o.out, "run folder (default runs/<soil>-sensitivity-<n>)");
  command.add_option("--seed", o.seed, "first packing seed, and seed of the design (default 1)")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--max-runs", o.max_runs, "at most this many simulations")
      ->check(CLI::PositiveNumber);
  command.add_option("--threads", o.num_threads, "threads (default: all processors)")
      ->check(CLI::Range(0, 1024));
  command.add_option("--lanes", o.max_lanes, "at most this many parameter sets per pack")
      ->check(CLI::IsMember({0, 1, 4, 8}));
  command.add_flag("--quick", o.quick, "a labelled preview: small specimens, few samples");
}

int run_sensitivity_command(const SensitivityCommandOptions& o, const std::string& command_line) {
  // 1. read and check everything, then make the folder
  const auto start = std::chrono::steady_clock::now();
  SensitivityStudy study = read_study(o);
  const std::atomic<bool>& stop = interrupt_flag();
  const std::filesystem::path folder =
      o.extend ? std::filesystem::path(o.out)
               : make_run_folder(o.out, study.soil.id + "-sensitivity");

  // 2. run
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, thread_count(o.num_threads), o.max_lanes, &stop};
  ProgressDisplay display(::isatty(STDERR_FILENO) != 0,
                          [](const std::string& line) { std::cerr << line << '\n'; });
  study.options.progress = [&display](const Progress& p) { display.show(p); };
  study.options.should_stop = [&stop] { return stop.load(); };
  const SensitivitySummary summary = run_sensitivity(
      study.parameters, study.targets, study_simulator(study, context), study.options);
  display.finish();

  // 3. write
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const SensitivityCardContext card{
      .report = {study.soil.id, study.provenance, study.fidelity == Fidelity::preview},
      .soil_id = study.soil.id,
      .seconds = elapsed.count(),
      .command = command_line,
      .inputs = study.inputs,
      .parameters = study.parameters};
  write_results(study, summary, card, folder);
  std::cout << sensitivity_report_text(summary, card.report)
            << fmt::format("results: {} ({:.0f} s)\n", folder.string(), elapsed.count());
  return exit_code_of(summary);
}

}  // namespace tilth
