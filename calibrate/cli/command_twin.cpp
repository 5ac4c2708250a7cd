// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_twin.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/cli/measured_features.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/twin_files.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/parallel.hpp"

namespace tilth {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> words_or_default(const std::vector<std::string>& words) {
  return words.empty() ? std::vector<std::string>{"laboratory"} : words;
}

TwinPlan read_plan(const TwinOptions& o) {
  TwinPlan plan;
  plan.tests = chosen_tests(words_or_default(o.tests));
  plan.effects = parse_effects(o.effects);
  plan.noise = {o.noise, o.rig_noise};
  plan.num_replicates = o.num_replicates;
  plan.fidelity = o.quick ? Fidelity::preview : Fidelity::search;
  plan.seed = o.seed;
  return plan;
}

std::string reproducing_command(const TwinOptions& o) {
  std::string text = "calibrate twin";
  text += o.soil_folder.empty() ? " --soil " + o.soil : " --data " + o.soil_folder;
  for (const std::string& e : o.effects) text += " --effect " + e;
  text += fmt::format(" --tests {} --noise {:g} --rig-noise {:g} --replicates {} --seed {}",
                      fmt::join(words_or_default(o.tests), ","), o.noise, o.rig_noise, o.num_replicates, o.seed);
  return text + (o.quick ? " --quick" : "");
}

/// The truth must not lie where a seeker looks, and nothing is overwritten.
void refuse_places(const TwinOptions& o) {
  std::vector<std::string> problems;
  if (o.out.empty()) problems.push_back("--out DIR: where the data go");
  if (o.truth.empty()) problems.push_back("--truth FILE: where the truth goes, outside the data folder");
  if (!o.out.empty() && fs::exists(o.out) && !fs::is_empty(o.out))
    problems.push_back(o.out + ": exists and is not empty");
  if (!o.truth.empty() && fs::exists(o.truth)) problems.push_back(o.truth + ": exists");
  if (!o.out.empty() && !o.truth.empty()) {
    const fs::path inside = fs::weakly_canonical(o.truth).lexically_relative(fs::weakly_canonical(o.out));
    if (!inside.empty() && *inside.begin() != "..") problems.push_back("--truth " + o.truth + ": lies inside the data folder");
  }
  if (!problems.empty()) throw ConfigError(problems);
}

}  // namespace

void add_twin_options(CLI::App& command, TwinOptions& o) {
  CLI::Option* soil = command.add_option("--soil", o.soil, "soil under data/soils whose parameters and state the truth is drawn about");
  command.add_option("--data", o.soil_folder, "a folder in the soil format, instead of --soil")->excludes(soil);
  command.add_option("--effect", o.effects, "hide this: id=size or id=typical (calibrate effects); may be repeated")->take_all();
  command.add_option("--tests", o.tests, "laboratory (default: element tests), bed (cone, vane, heap), sweep (draught and tracers), all, or test ids")->delimiter(',');
  command.add_option("--noise", o.noise, "coefficient of variation of a specimen's numbers (default 0.10)")->check(CLI::Range(0.0, 1.0));
  command.add_option("--rig-noise", o.rig_noise, "that of one unknown factor per rig (default 0.03)")->check(CLI::Range(0.0, 0.5));
  command.add_option("--replicates", o.num_replicates, "specimens of every test (default 5)")->check(CLI::Range(2, 100));
  command.add_option("--seed", o.seed, "of truth, packings and noise (default 1)")->check(CLI::NonNegativeNumber);
  command.add_flag("--quick", o.quick, "specimens as small as those of diagnose --quick");
  command.add_option("--out", o.out, "data folder to make");
  command.add_option("--truth", o.truth, "file for the truth, outside the data folder");
  command.add_option("--threads", o.num_threads, "0: all processors");
}

int run_twin_command(const TwinOptions& o) {
  const TwinPlan plan = read_plan(o);
  refuse_places(o);
  const fs::path source = chosen_soil_folder(o.soil, o.soil_folder);
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, threads_or_all(o.num_threads)};
  const TwinData twin = make_twin(load_soil(source), plan, context);

  const fs::path out(o.out);
  const fs::path named = fs::weakly_canonical(out).filename();
  write_file(out / "soil.json", twin_soil_json(twin.soil, named.string()));
  write_file(out / "conditions.csv", conditions_csv(twin.soil.conditions));
  write_file(out / "measurements.csv", measurements_csv(twin.soil.targets));
  fs::copy_file(source / "parameters.csv", out / "parameters.csv");
  write_file(o.truth, twin_truth_json(twin, plan, source.filename().string(), reproducing_command(o)));
  std::cout << fmt::format("{} numbers of {} tests in {}; the truth is in {}\n", twin.soil.targets.size(),
                           plan.tests.size(), out.string(), o.truth);
  if (!twin.lost.empty()) std::cout << fmt::format("{} specimens were lost, as the truth file tells\n", twin.lost.size());
  return exit_done;
}

}  // namespace tilth
