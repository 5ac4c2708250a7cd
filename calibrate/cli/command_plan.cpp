// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_plan.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <set>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/csv_table.hpp"
#include "calibrate/parallel.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

/// Core-seconds of one run of a test at a fidelity, per state of a series.
using Costs = std::map<std::pair<std::string, std::string>, double>;

Costs read_costs() {
  std::vector<std::string> problems;
  const CsvTable table = read_csv(data_root() / "test_costs.csv",
                                  {{"experiment", "fidelity", "core_s", "provenance", "source"}, {}}, problems);
  Costs costs;
  for (const CsvRow& row : table.rows) {
    CsvRowReader reader(table, row, problems);
    const std::string test = reader.text("experiment"), fidelity = reader.text("fidelity");
    if (const auto core_s = reader.number("core_s")) costs[{test, fidelity}] = *core_s;
  }
  if (!problems.empty()) throw ConfigError(problems);
  return costs;
}

/// Core-seconds of all tests of one parameter set on one packing; a series counts each of its states.
/// Tests whose cost is not in the table are named in `unknown`, once each.
double core_s_per_simulation(const FitJob& job, const std::string& simulator, const Costs& costs,
                             std::set<std::string>& unknown) {
  const Fidelity fidelity = simulator == "search" ? job.search : job.confirm;
  double sum = 0.0;
  for (const PlannedTest& test :
       plan_tests(job.soil, fidelity,
                  simulator == "hold-outs" ? TargetScope::holdouts : TargetScope::fitted)) {
    const auto* series = std::get_if<DrainedTriaxialConfig>(&test.config);
    const double states = series ? static_cast<double>(series->cell_pressure_Pa.size()) : 1.0;
    const auto cost = costs.find({test_id(test.config), name_of(fidelity)});
    if (cost == costs.end()) unknown.insert(fmt::format("{} ({})", test_id(test.config), name_of(fidelity)));
    else sum += states * cost->second;
  }
  return sum;
}

/// As in fit(): independent observations and priors against free parameters.
void print_gates(const FitJob& job) {
  const std::vector<Parameter> parameters = fit_parameters(job.soil);
  const std::vector<std::size_t> free = free_parameters(parameters);
  const auto num_priors = static_cast<std::size_t>(std::ranges::count_if(
      free, [&](std::size_t i) { return parameters[i].prior_mean.has_value(); }));
  const std::size_t independent = num_independent_observations(job.soil.targets) + num_priors;
  std::cout << fmt::format("gates that can be judged now\n"
                           "  under-determination  {}: {} free parameters, {} independent observations\n"
                           "  hold-out             {} targets held out; criterion: rms residual at most {}\n"
                           "  noise floor, reachability: need the runs of the design\n",
                           free.size() <= independent ? "passed" : "failed (--force)", free.size(), independent,
                           std::ranges::count_if(job.soil.targets, &SoilTarget::holdout),
                           job.options.holdout_limit);
}

}  // namespace

void add_plan_options(CLI::App& command, PlanOptions& o) {
  add_job_options(command, o.job);
  command.add_option("--threads", o.num_threads, "workers the fit will have (default: all processors)")
      ->check(CLI::Range(0, 1024));
}

int run_plan(const PlanOptions& o) {
  const FitJob job = read_job(o.job);
  refuse_bad_job(job, {});
  const Costs costs = read_costs();
  const bool has_holdouts = std::ranges::any_of(job.soil.targets, &SoilTarget::holdout);
  const int threads = threads_or_all(o.num_threads);
  std::set<std::string> unknown;
  for (const std::string& w : job.soil.warnings) std::cerr << w << '\n';
  std::cout << fmt::format("{}: {}\n{:<14} {:<10} {:>6} {:>18} {:>12}\n", job.soil.name,
                           provenance_sentence(job.soil), "stage", "simulator", "runs",
                           "core-s per run", "core-hours");
  double total_s = 0.0;
  std::size_t total = 0;
  for (const PlannedStage& stage : planned_stages(
           job.options, num_free_parameters(job.soil.parameters), true, has_holdouts)) {
    const double each = core_s_per_simulation(job, stage.simulator, costs, unknown);
    const double sum = each * static_cast<double>(stage.num_simulations);
    std::cout << fmt::format("{:<14} {:<10} {:>6} {:>18.2f} {:>12.3f}\n", stage.stage, stage.simulator,
                             stage.num_simulations, each, sum / 3600);
    total_s += sum;
    total += stage.num_simulations;
  }
  std::cout << fmt::format("{:<25} {:>6} {:>18} {:>12.3f}\n"
                           "about {:.0f} minutes on {} processors like those of data/test_costs.csv; at most {} runs\n",
                           "in all", total, "", total_s / 3600, total_s / 60 / threads, threads,
                           job.options.max_simulations);
  for (const std::string& test : unknown)
    std::cout << fmt::format("not counted: {}, whose cost is not in data/test_costs.csv\n", test);
  print_gates(job);
  return exit_done;
}

}  // namespace tilth
