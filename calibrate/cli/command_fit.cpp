// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_fit.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "calibrate/cli/command_report.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/fit_job.hpp"
#include "calibrate/cli/fit_output.hpp"
#include "calibrate/cli/profile_output.hpp"
#include "calibrate/cli/progress_display.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/fit.hpp"
#include "calibrate/fit_report.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

/// The log of one run: standard error (unless a live bar has it) and log.txt.
spdlog::logger make_log(const std::filesystem::path& folder, bool quiet_terminal) {
  auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>((folder / "log.txt").string());
  file->set_pattern("%Y-%m-%d %H:%M:%S %l %v");
  auto screen = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  screen->set_pattern("%v");
  if (quiet_terminal) screen->set_level(spdlog::level::warn);
  spdlog::logger log("calibrate", {file, screen});
  log.flush_on(spdlog::level::info);
  return log;
}

int exit_code_of(const FitSummary& s) {
  switch (s.termination) {
    case Termination::bad_input:
    case Termination::under_determined: return exit_bad_input;
    case Termination::budget_spent:
    case Termination::stopped: return exit_budget;
    case Termination::too_many_failures: return exit_failed_runs;
    case Termination::not_called: return exit_internal;
    case Termination::no_convergence: return s.is_usable() ? exit_budget : exit_failed_runs;
    case Termination::converged: break;
  }
  if (s.has_unreachable_target()) return exit_unreachable;
  return s.holdout_failed() ? exit_holdout_failed : exit_done;
}

std::string criterion_text(const FitOptions& options) {
  return fmt::format("root mean square of the hold-out residuals (in total sigma) at most {}",
                     options.holdout_limit);
}

void write_card(const FitJob& job, const FitSummary& summary, const FitCardContext& card,
                const std::filesystem::path& folder) {
  const ReportContext report{card.provenance_sentence +
                             (card.quick ? "\nPREVIEW (--quick): small, fast specimens and few "
                                           "packings; do not publish these numbers"
                                         : "")};
  write_file(folder / "fit.json", fit_card_json(job.soil, summary, card));
  write_file(folder / "fit_report.txt", fit_report_text(summary, report));
}

/// The card is written before the tests are run once more, and again with what they add to it.
void write_results(const FitJob& job, FitSummary& summary, const FitCardContext& card,
                   const RunSession& session, const std::filesystem::path& folder,
                   spdlog::logger& log) {
  write_card(job, summary, card, folder);
  for (const std::string& sentence : write_profiles(job.soil, summary, folder)) log.warn(sentence);
  if (!summary.is_usable() || session.should_stop()) return;
  log.info("drawing curves at the fitted values");
  FitCurves curves = write_curves_and_figures(job.soil, summary, job.search, job.confirm,
                                              job.options.seed + 3000, session.context(), folder);
  for (const std::string& sentence : curves.missing) log.warn(sentence);
  summary.sample_sizes = std::move(curves.sample_sizes);
  if (!summary.sample_sizes.empty()) write_card(job, summary, card, folder);
}

std::string reproducing_command(const FitCommandOptions& o) {
  return job_command(o.job) + (o.max_runs > 0 ? fmt::format(" --max-runs {}", o.max_runs) : "");
}

void say_end(const RunSession& session, spdlog::logger& log) {
  const BrokerCounts& c = session.counts();
  log.info("{} tests simulated, {} taken from the store, {} started again", c.num_simulated,
           c.num_from_store, c.num_retries);
  if (session.should_stop())
    log.warn("{}: the report says what is known so far; go on with --resume", session.stop_reason());
}

/// The linear interval; without one that of the profile, "-" where it does not end inside the bounds.
std::string interval_words(const FittedParameter& p) {
  if (!std::isnan(p.lo95)) return fmt::format("[{:.4g}, {:.4g}]", p.lo95, p.hi95);
  const auto end = [](double x) { return std::isnan(x) ? std::string("-") : fmt::format("{:.4g}", x); };
  return fmt::format("[{}, {}] (profile)", end(p.profile_lo95), end(p.profile_hi95));
}

}  // namespace

void add_fit_options(CLI::App& app, FitCommandOptions& o) {
  add_job_options(app, o.job);
  app.add_option("--max-runs", o.max_runs,
                 "end after this many runs (parameter sets times packings), those of the store included")
      ->check(CLI::PositiveNumber);
  add_session_options(app, o.session);
}

int run_fit(const FitCommandOptions& o, const std::string& command_line) {
  // 1. read and check everything, then open the folder
  FitJob job = read_job(o.job);
  if (o.max_runs > 0) job.options.max_simulations = o.max_runs;
  refuse_bad_job(job, problems(o.session));
  const FitCardContext card{.seed = o.job.seed,
                            .quick = o.job.quick,
                            .provenance_sentence = provenance_sentence(job.soil),
                            .measured_share = measured_share(job.soil.targets),
                            .search = job.search,
                            .confirm = job.confirm,
                            .command = reproducing_command(o),
                            .inputs = job.inputs,
                            .criterion = criterion_text(job.options)};
  const std::filesystem::path folder =
      open_run_folder(o.session, job.soil.id, run_config_json(job.soil, job.options, card));
  const RunSession session(o.session, folder);

  // 2. say what will be done
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  spdlog::logger log = make_log(folder, terminal);
  log.info("{}: {}", job.soil.name, card.provenance_sentence);
  for (const std::string& w : job.soil.warnings) log.warn(w);
  if (const std::string note = session.store_note(); !note.empty()) log.warn(note);
  log.info("fitting {} parameters with {} workers into {}",
           num_free_parameters(job.soil.parameters), session.num_workers(), folder.string());

  // 3. fit
  ProgressDisplay display(terminal, [&log](const std::string& line) { log.info(line); });
  job.options.progress = [&display](const Progress& p) { display.show(p); };
  job.options.report_gate = [&log](const Gate& gate) {
    log.log(gate.passed ? spdlog::level::info : spdlog::level::warn, "gate {}: {} ({})", gate.name,
            gate.passed ? "passed" : "failed", gate.words);
  };
  job.options.should_stop = [&session] { return session.should_stop(); };
  using enum TargetScope;
  const Simulator search = dem_simulator(job.soil, job.search, session.context(), fitted);
  const Simulator confirm = dem_simulator(job.soil, job.confirm, session.context(), fitted);
  const Simulator holdout = dem_simulator(job.soil, job.confirm, session.context(), holdouts);
  const bool has_holdouts = std::ranges::any_of(job.soil.targets, &SoilTarget::holdout);
  FitSummary summary = fit(fit_parameters(job.soil), fit_targets(job.soil), search, &confirm,
                           job.options, has_holdouts ? &holdout : nullptr);
  display.finish();
  show_ties(job.soil.parameters, summary);

  // 4. write
  write_results(job, summary, card, session, folder, log);
  write_file(folder / "timing.json", session.timing_json(command_line));
  write_file(folder / "report.html", report_page(folder));
  say_end(session, log);
  log.info(summary.brief_report());
  std::cout << card.provenance_sentence << '\n';
  for (const FittedParameter& p : summary.parameters)
    if (p.estimate)
      std::cout << fmt::format("{:<28} {:>12.5g}   95 % {}   {}\n", p.name, p.value, interval_words(p),
                               verdict_words(p));
  std::cout << fmt::format("results: {} ({} s)\n", folder.string(),
                           static_cast<int>(session.seconds() + 0.5));
  return exit_code_of(summary);
}

}  // namespace tilth
