// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_sensitivity.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/progress_display.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/run_session.hpp"
#include "calibrate/cli/sensitivity_card.hpp"
#include "calibrate/cli/sensitivity_figures.hpp"
#include "calibrate/cli/sensitivity_study.hpp"

namespace tilth {
namespace {

/// A test that fails takes no other test's features with it. What the session's store holds is not
/// simulated again.
Simulator study_simulator(const SensitivityStudy& study, const RunContext& context) {
  return dem_simulator(study.soil, study.fidelity, context, TargetScope::all,
                       FailedTest::leaves_others);
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
  command.add_option("--tests", o.tests,
                     "these tests with all their features, instead of the soil's own: laboratory, bed, sweep, "
                     "all or test names, separated by commas")
      ->delimiter(',');
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
  command.add_option("--seed", o.seed, "first packing seed, and seed of the design (default 1)")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--max-runs", o.max_runs, "at most this many simulations")
      ->check(CLI::PositiveNumber);
  add_session_options(command, o.session);
  command.add_flag("--quick", o.quick, "a labelled preview: small specimens, few samples");
}

int run_sensitivity_command(const SensitivityCommandOptions& o, const std::string& command_line) {
  // 1. read and check everything, then open the folder
  SensitivityStudy study = read_study(o);
  const std::string config = sensitivity_config_json(study);
  const std::filesystem::path folder =
      o.extend ? std::filesystem::path(o.session.out)
               : open_run_folder(o.session, study.soil.id + "-sensitivity", config);
  const RunSession session(o.session, folder);
  if (o.extend) write_file(folder / "config.json", config);
  if (const std::string note = session.store_note(); !note.empty()) std::cerr << note << '\n';

  // 2. run
  ProgressDisplay display(::isatty(STDERR_FILENO) != 0,
                          [](const std::string& line) { std::cerr << line << '\n'; });
  study.options.progress = [&display](const Progress& p) { display.show(p); };
  study.options.should_stop = [&session] { return session.should_stop(); };
  const SensitivitySummary summary = run_sensitivity(
      study.parameters, study.targets, study_simulator(study, session.context()), study.options);
  display.finish();

  // 3. write
  const SensitivityCardContext card{
      .report = {study.soil.id, study.provenance, study.fidelity == Fidelity::preview},
      .soil_id = study.soil.id,
      .command = command_line,
      .inputs = study.inputs,
      .parameters = study.parameters,
      .tests = study.tests};
  write_results(study, summary, card, folder);
  write_file(folder / "timing.json", session.timing_json(command_line));
  if (session.should_stop())
    std::cerr << session.stop_reason() << ": the report says what is known so far; go on with "
              << "--resume\n";
  std::cout << sensitivity_report_text(summary, card.report)
            << fmt::format("results: {} ({} tests simulated, {} from the store, {:.0f} s)\n",
                           folder.string(), session.counts().num_simulated,
                           session.counts().num_from_store, session.seconds());
  return exit_code_of(summary);
}

}  // namespace tilth
