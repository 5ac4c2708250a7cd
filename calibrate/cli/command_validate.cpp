// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_validate.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/validation_card.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/soil_fit.hpp"
#include "calibrate/validation.hpp"

namespace tilth {
namespace {

/// The parameters of the data folder with the values, bounds and scales of the fit.
std::vector<Parameter> fitted_parameters(const SoilData& soil, const FittedUncertainty& fit) {
  std::vector<Parameter> parameters = fit_parameters(soil);
  std::vector<std::string> problems;
  for (Parameter& p : parameters) {
    const auto fitted = std::ranges::find(fit.parameters, p.name, &Parameter::name);
    if (fitted == fit.parameters.end())
      problems.push_back(fmt::format("{} in parameters.csv is not in the fit", p.name));
    else p = *fitted;
  }
  if (parameters.size() != fit.parameters.size())
    problems.push_back(fmt::format("parameters.csv has {} parameters, the fit {}", parameters.size(),
                                   fit.parameters.size()));
  if (!problems.empty()) throw ConfigError(problems);
  return parameters;
}

std::string known_number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.3g}", value); }

std::string report_text(const Validation& v, const FittedUncertainty& fit, const std::string& provenance) {
  std::string text = fmt::format("{}\n{}fit: {}\ncriterion: {}\nfound: rms residual {:.3g}, pass mark {:.3g}: {}\n\n",
                                 provenance, fit.preview ? "PREVIEW: the fit was made with --quick\n" : "",
                                 fit.soil_id, fit.criterion, v.rms, v.limit, v.passed() ? "passed" : "failed");
  if (!v.has_parameter_errors)
    text += "the intervals hold no part of the parameters: no covariance in the fit, or the runs around it failed\n";
  if (v.num_seeds == 1)
    text += "the intervals hold no part of the packings: only one completed\n";
  text += fmt::format("{:<72} {:>12} {:>9} {:>12} {:>10} {:>10} {:>9}  {}\n", "target", "value", "sigma", "simulated",
                      "seed sd", "param. sd", "residual", "provenance");
  for (const TargetResult& t : v.targets)
    text += fmt::format("{:<72} {:>12.5g} {:>9.3g} {:>12.5g} {:>10} {:>10} {:>+9.2f}  {}{}\n", t.name, t.value,
                        t.sigma, t.simulated, known_number(t.seed_sd), known_number(t.parameter_sd), t.residual,
                        to_string(t.provenance), t.log_transform ? " (sigma and sd of ln)" : "");
  text += fmt::format("\n{} packings, {} simulations, {} failed\n", v.num_seeds, v.num_simulations, v.failures.size());
  for (const FailedRun& f : v.failures) text += fmt::format("failed: packing {}: {}\n", f.seed, f.message);
  return text;
}

int exit_code_of(const Validation& v) {
  if (v.stopped) return exit_budget;
  if (v.targets.empty()) return exit_failed_runs;
  return v.passed() ? exit_done : exit_holdout_failed;
}

}  // namespace

void add_validate_options(CLI::App& command, ValidateOptions& o) {
  command.add_option("fit", o.fit, "fit.json or run folder")->required();
  command.add_option("--data", o.data, "folder in the soil format with the new data")->required();
  command.add_option("--seeds", o.num_seeds, "packings (default 4)")->check(CLI::Range(2, 1000));
  add_session_options(command, o.session);
}

int run_validate(const ValidateOptions& o, const std::string& command_line) {
  const FittedUncertainty fit = read_fitted_uncertainty(o.fit);
  const SoilData soil = load_soil(o.data);
  ValidationProblem problem;
  problem.parameters = fitted_parameters(soil, fit);
  problem.covariance = fit.covariance;
  problem.targets = fit_targets(soil);
  problem.limit = fit.limit;
  // the fit used seed ... seed + 3999
  for (int k = 0; k < o.num_seeds; ++k) problem.seeds.push_back(fit.seed + 4000 + static_cast<std::uint64_t>(k));
  if (const std::vector<std::string> wrong = problems(o.session); !wrong.empty()) throw ConfigError(wrong);
  const Fidelity fidelity = fit.preview ? Fidelity::search : Fidelity::confirm;
  (void)plan_tests(soil, fidelity);
  const std::filesystem::path folder = open_run_folder(
      o.session, "validate-" + soil.id, validation_config_json(fit, soil.id, problem.seeds));
  const RunSession session(o.session, folder);
  problem.should_stop = [&session] { return session.should_stop(); };
  const Validation v = validate(problem, dem_simulator(soil, fidelity, session.context()));
  const std::string text = report_text(v, fit, provenance_sentence(soil));
  write_file(folder / "validation.json", validation_json(v, fit, soil.id));
  write_file(folder / "validation.txt", text);
  write_file(folder / "timing.json", session.timing_json(command_line));
  std::cout << text << "results: " << folder.string() << '\n';
  return exit_code_of(v);
}

}  // namespace tilth
