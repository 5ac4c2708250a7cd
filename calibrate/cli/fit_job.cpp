// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/fit_job.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/target_choice.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/fit.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {

void add_job_options(CLI::App& app, JobOptions& o) {
  CLI::Option* soil = app.add_option("--soil", o.soil, "soil under data/soils, e.g. loamy_sand; all: those fitted with the same parameters");
  app.add_option("--data", o.soil_folder, "a folder in the soil format, instead of --soil")
      ->excludes(soil);
  app.add_option("--config", o.config, "changes to parameters, targets and fit (JSON, tilth.fit/1)");
  app.add_option("--tests", o.tests, "whose targets: mechanical, sweep (draught, tracers) or all (default; with --quick mechanical)")
      ->check(CLI::IsMember({"mechanical", "sweep", "all"}));
  app.add_option("--seed", o.seed, "first packing seed (default 1)")->check(CLI::NonNegativeNumber);
  app.add_flag("--quick", o.quick, "a labelled preview: small specimens, few packings");
  app.add_flag("--force", o.force, "fit even with more free parameters than observations");
}

std::string job_command(const JobOptions& o) {
  std::string text = o.soil_folder.empty() ? "calibrate --soil " + o.soil
                                           : "calibrate --data " + o.soil_folder;
  if (!o.config.empty()) text += " --config " + o.config;
  if (!o.tests.empty()) text += " --tests " + o.tests;
  text += fmt::format(" --seed {}", o.seed);
  if (o.quick) text += " --quick";
  if (o.force) text += " --force";
  return text;
}

namespace {

/// Leaves the targets of the tests asked for; a preview that was not asked for any leaves out the sweep.
void choose_targets(const JobOptions& o, SoilData& soil) {
  if (!o.tests.empty()) return choose_tests(o.tests, soil);
  if (const std::size_t num_left_out = o.quick ? leave_out_sweep(soil) : 0; num_left_out > 0)
    soil.warnings.push_back(
        fmt::format("this preview leaves out the {} targets of the sweep; --tests all takes them in", num_left_out));
}

/// Numbers of a model beside numbers of a soil: the share that is made up must not go unsaid.
void warn_of_synthetic_targets(SoilData& soil) {
  const auto num_fitted = std::ranges::count(soil.targets, false, &SoilTarget::holdout);
  const auto num_synthetic = std::ranges::count_if(soil.targets, [](const SoilTarget& t) {
    return !t.holdout && t.origin.provenance == Provenance::synthetic;
  });
  if (num_synthetic > 0 && num_synthetic < num_fitted)
    soil.warnings.push_back(fmt::format("{} of {} targets of the fit are synthetic: made by a model, they say nothing about soil",
                                        num_synthetic, num_fitted));
}

}  // namespace

FitJob read_job(const JobOptions& o) {
  FitJob job;
  const std::filesystem::path folder = chosen_soil_folder(o.soil, o.soil_folder);
  job.soil = load_soil(folder);
  choose_targets(o, job.soil);
  job.options = o.quick ? quick_fit_options() : FitOptions{};
  job.options.seed = o.seed;
  job.options.force = o.force;
  job.inputs = soil_tables(folder);
  if (!o.config.empty()) {
    apply_run_config(o.config, job.soil, job.options);
    job.inputs.emplace_back(o.config);
  }
  if (o.quick) {
    job.search = Fidelity::preview;
    job.confirm = Fidelity::search;
  }
  warn_of_synthetic_targets(job.soil);
  (void)material_of(job.soil, nominal_values(job.soil));
  return job;
}

void refuse_bad_job(const FitJob& job, std::vector<std::string> found) {
  for (const std::string& p : problems(job.options)) found.push_back(p);
  if (!found.empty()) throw ConfigError(found);
  // What fit() itself refuses: one that is told to stop at once looks at its input and runs nothing.
  FitOptions options = job.options;
  options.should_stop = [] { return true; };
  const FitSummary s = fit(fit_parameters(job.soil), fit_targets(job.soil), Simulator(), nullptr,
                           options);
  if (s.termination == Termination::bad_input || s.termination == Termination::under_determined)
    throw ConfigError({s.message});
}

}  // namespace tilth
