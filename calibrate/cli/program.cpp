// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/program.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "calibrate/cli/command_cache.hpp"
#include "calibrate/cli/command_check.hpp"
#include "calibrate/cli/command_diagnose.hpp"
#include "calibrate/cli/command_effects.hpp"
#include "calibrate/cli/command_export.hpp"
#include "calibrate/cli/command_features.hpp"
#include "calibrate/cli/command_fit.hpp"
#include "calibrate/cli/command_plan.hpp"
#include "calibrate/cli/command_report.hpp"
#include "calibrate/cli/command_scale.hpp"
#include "calibrate/cli/command_sensitivity.hpp"
#include "calibrate/cli/command_simulate.hpp"
#include "calibrate/cli/command_twin.hpp"
#include "calibrate/cli/command_validate.hpp"
#include "calibrate/cli/command_worker.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/fit_all_soils.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/tool_info.hpp"
#include "calibrate/config_error.hpp"

namespace tilth {
namespace {

std::string command_line_of(int argc, const char* const* argv) {
  std::string text = "calibrate";
  for (int k = 1; k < argc; ++k) text += std::string(" ") + argv[k];
  return text;
}

int say_bad_input(const ConfigError& error) {
  const auto& sentences = error.sentences();
  if (sentences.size() > 1) std::cerr << sentences.size() << " problems:\n";
  for (const std::string& s : sentences) std::cerr << (sentences.size() > 1 ? "- " : "") << s << '\n';
  return exit_bad_input;
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  CLI::App app("calibrate: fits a bonded-particle (DEM) soil model to soil tests");
  app.set_version_flag("--version", std::string("tilth ") + tool_version + " (" + tool_commit + ")");
  FitCommandOptions fit_options;
  CheckOptions check_options;
  SimulateOptions simulate_options;
  EffectsOptions effects_options;
  ExportOptions export_options;
  FeaturesOptions features_options;
  WorkerOptions worker_options;
  CacheOptions cache_options;
  PlanOptions plan_options;
  ReportOptions report_options;
  ValidateOptions validate_options;
  SensitivityCommandOptions sensitivity_options;
  ScaleCommandOptions scale_options;
  TwinOptions twin_options;
  DiagnoseOptions diagnose_options;
  add_fit_options(app, fit_options);
  CLI::App* check = app.add_subcommand("check", "list every problem of a data folder or config");
  add_check_options(*check, check_options);
  CLI::App* simulate = app.add_subcommand("simulate", "run one virtual test");
  add_simulate_options(*simulate, simulate_options);
  CLI::App* effects =
      app.add_subcommand("effects", "the candidate missing effects: parameters, sizes, laws, sources");
  add_effects_options(*effects, effects_options);
  CLI::App* exporting = app.add_subcommand("export", "write a fitted set for other DEM codes");
  add_export_options(*exporting, export_options);
  CLI::App* features =
      app.add_subcommand("features", "rows of measurements.csv from measured curves");
  add_features_options(*features, features_options);
  CLI::App* plan = app.add_subcommand("plan", "runs and core-hours a fit will take; starts nothing");
  add_plan_options(*plan, plan_options);
  CLI::App* validate = app.add_subcommand("validate", "a fitted set against data that took no part in it");
  add_validate_options(*validate, validate_options);
  CLI::App* report = app.add_subcommand("report", "report.html from the files of a run folder");
  add_report_options(*report, report_options);
  CLI::App* cache = app.add_subcommand("cache", "list, show, remove and merge stored simulations");
  add_cache_options(*cache, cache_options);
  CLI::App* worker = app.add_subcommand("worker", "simulations on request, line by line");
  worker->group("");  // not for people
  add_worker_options(*worker, worker_options);
  CLI::App* sensitivity =
      app.add_subcommand("sensitivity", "which parameters move which features (Morris, Sobol)");
  add_sensitivity_options(*sensitivity, sensitivity_options);
  CLI::App* scale = app.add_subcommand("scale", "how large particles may be before tracers go elsewhere");
  add_scale_options(*scale, scale_options);
  CLI::App* diagnose =
      app.add_subcommand("diagnose", "find where simulation and measurement disagree, and which effect is missing");
  add_diagnose_options(*diagnose, diagnose_options);
  CLI::App* twin = app.add_subcommand("twin", "make measurements with a hidden truth");
  add_twin_options(*twin, twin_options);
  app.require_subcommand(0, 1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? exit_done : exit_bad_input;
  }
  const std::string command_line = command_line_of(argc, argv);
  try {
    if (check->parsed()) return run_check(check_options);
    if (simulate->parsed()) return run_simulate(simulate_options, command_line);
    if (effects->parsed()) return run_effects(effects_options);
    if (features->parsed()) return run_features(features_options);
    if (sensitivity->parsed())
      return run_sensitivity_command(sensitivity_options, command_line);
    if (diagnose->parsed()) return run_diagnose_command(diagnose_options, command_line);
    if (twin->parsed()) return run_twin_command(twin_options);
    if (scale->parsed()) return run_scale_command(scale_options, command_line);
    if (exporting->parsed()) return run_export(export_options);
    if (plan->parsed()) return run_plan(plan_options);
    if (validate->parsed()) return run_validate(validate_options, command_line);
    if (report->parsed()) return run_report(report_options);
    if (cache->parsed()) return run_cache(cache_options);
    if (worker->parsed()) return run_worker_command(worker_options);
    if (fit_options.job.soil == "all") return run_fit_of_all_soils(fit_options, command_line);
    return run_fit(fit_options, command_line);
  } catch (const ConfigError& e) {
    return say_bad_input(e);
  } catch (const WriteError& e) {
    std::cerr << e.what() << '\n';
    return exit_internal;
  } catch (const std::exception& e) {
    std::cerr << "internal error: " << e.what() << '\n';
    return exit_internal;
  }
}

}  // namespace tilth
