// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_diagnose.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "calibrate/cli/diagnosis_decision.hpp"
#include "calibrate/cli/diagnosis_report.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/extended_fit.hpp"
#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/progress_display.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/target_choice.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> soil_folders(const DiagnoseOptions& o) {
  if (o.soil != "all") return {chosen_soil_folder(o.soil, o.soil_folder)};
  if (!o.fit.empty()) throw ConfigError({"--fit is of one soil, --soil says all"});
  std::vector<fs::path> all;
  for (const std::string& name : soils_of_all()) all.push_back(soil_folder(data_root(), name));
  return all;
}

/// The rule of fits: more than 30 % of at least eight runs.
bool too_many_failed(const SimulationLedger& ledger) {
  return ledger.num_done >= ledger.min_batch_for_failure_rule &&
         static_cast<double>(ledger.failures.size()) > SimulationLedger{}.max_failed_share * static_cast<double>(ledger.num_done);
}

/// The baseline of a fit, in the order of the soil's parameters. @throws ConfigError
std::optional<Eigen::VectorXd> given_values(const std::string& fit, const SoilCase& soil) {
  if (fit.empty()) return std::nullopt;
  const FittedSet set = read_fit_card(fit);
  Eigen::VectorXd values = nominal_values(soil.campaign.means);
  for (std::size_t k = 0; k < soil.parameters.size(); ++k) {
    const auto found = std::ranges::find(set.parameters, soil.parameters[k].name, &FittedSet::Value::name);
    if (found != set.parameters.end()) values[static_cast<Eigen::Index>(k)] = found->value;
    else if (soil.parameters[k].estimate)
      throw ConfigError({fmt::format("--fit {}: has no {}, which the soil says is fitted", fit, soil.parameters[k].name)});
  }
  return values;
}

/// Leaves the targets that are diagnosed: a bin in each of some 500 simulations is there only when asked for.
/// @return what the report must say of it; empty if nothing
std::string choose_targets(const DiagnoseOptions& o, SoilData& soil) {
  if (!o.tests.empty()) choose_tests(o.tests, soil);
  const std::size_t num_left_out = o.tests.empty() ? leave_out_sweep(soil) : 0;
  if (num_left_out == 0) return "";
  return fmt::format("the {} targets of the sweep are left out; --tests all takes them in", num_left_out);
}

/// The cases with what the report must say of their data.
void read_soils(const DiagnoseOptions& o, DiagnosisResult& result, DiagnosisContext& context) {
  for (const fs::path& folder : soil_folders(o)) {
    SoilData soil = load_soil(folder);
    const std::string left_out = choose_targets(o, soil);
    result.soils.push_back(soil_case(soil));
    if (!left_out.empty()) {
      std::cerr << soil.id << ": " << left_out << '\n';
      result.soils.back().remarks.push_back(left_out);
    }
    context.provenance_sentence += (context.provenance_sentence.empty() ? "" : "; ") + soil.id + ": " + provenance_sentence(soil);
    for (const fs::path& file : soil_tables(folder)) context.inputs.push_back(file);
  }
}

std::string reproducing_command(const DiagnoseOptions& o) {
  std::string text = o.soil_folder.empty() ? "calibrate diagnose --soil " + o.soil : "calibrate diagnose --data " + o.soil_folder;
  if (!o.fit.empty()) text += " --fit " + o.fit;
  if (!o.tests.empty()) text += " --tests " + o.tests;
  return text + fmt::format(" --seed {}{}{}", o.seed, o.quick ? " --quick" : "", o.apply ? " --apply" : "");
}

/// The contenders an experiment should tell apart: the set, or a suggested name and its rivals.
std::vector<std::size_t> open_contenders(const DiagnosisResult& r) {
  const bool is_open = r.diagnosis.verdict == Verdict::set || r.diagnosis.verdict == Verdict::suggested;
  std::vector<std::size_t> open;
  if (!is_open) return open;
  const auto& choices = r.soils.front().choices;
  for (const std::string& id : r.contenders)
    for (std::size_t k = 0; k < choices.size(); ++k)
      if (choices[k].candidate.id == id) open.push_back(k);
  return open;
}

}  // namespace

void add_diagnose_options(CLI::App& command, DiagnoseOptions& o) {
  CLI::Option* soil = command.add_option("--soil", o.soil, "soil under data/soils, or all: pooled");
  command.add_option("--data", o.soil_folder, "a folder in the soil format, instead of --soil")->excludes(soil);
  command.add_option("--fit", o.fit, "fit.json or run folder: baseline values, instead of an own fit");
  command.add_option("--tests", o.tests,
                     "whose targets: mechanical, sweep (draught, tracers) or all (default: without the sweep, where others are)")
      ->check(CLI::IsMember({"mechanical", "sweep", "all"}));
  command.add_option("--seed", o.seed, "first packing seed (default 1)")->check(CLI::NonNegativeNumber);
  command.add_flag("--quick", o.quick, "a labelled preview: small specimens, fewer packings");
  command.add_flag("--apply", o.apply, "write fit.json of the model with the named effect");
  add_session_options(command, o.session);
}

int run_diagnose_command(const DiagnoseOptions& o, const std::string& command_line) {
  // 1. read and check everything, then open the folder
  if (const auto found = problems(o.session); !found.empty()) throw ConfigError(found);
  const DiagnosisSettings settings = diagnosis_settings(o.quick, o.seed);
  DiagnosisResult result;
  DiagnosisContext context{.settings = settings, .command = reproducing_command(o), .preview = o.quick};
  read_soils(o, result, context);
  std::vector<std::optional<Eigen::VectorXd>> values;
  for (const SoilCase& s : result.soils) values.push_back(given_values(o.fit, s));
  const std::string stem = result.soils.size() > 1 ? "all" : result.soils.front().campaign.means.id;
  const fs::path folder =
      open_run_folder(o.session, stem + "-diagnosis", diagnosis_config_json(result.soils, settings, o.quick));
  const RunSession session(o.session, folder);
  if (const std::string note = session.store_note(); !note.empty()) std::cerr << note << '\n';

  // 2. simulate and decide
  ProgressDisplay display(::isatty(STDERR_FILENO) != 0, [](const std::string& line) { std::cerr << line << '\n'; });
  SimulationLedger ledger;
  ledger.max_simulations = 1'000'000;
  ledger.max_failed_share = 1.0;  // a failed effect is reported, not fatal
  ledger.should_stop = [&session] { return session.should_stop(); };
  ledger.progress = [&display](const Progress& p) { display.show(p); };
  const DiagnosisRunner runner(settings, session.context(), ledger);
  for (const SoilCase& s : result.soils) ledger.num_expected += runner.expected_simulations(s);
  for (std::size_t s = 0; s < result.soils.size(); ++s) runner.gather(result.soils[s], values[s]);
  result.diagnosis = decided(result.soils, settings.statistics);
  const auto models = result.diagnosis.soils.empty() ? std::vector<std::vector<std::size_t>>{} : contenders_of(result.diagnosis);
  for (const auto& model : models)
    for (const std::size_t k : model) result.contenders.push_back(result.soils.front().choices[k].candidate.id);
  if (!models.empty())
    for (SoilCase& s : result.soils) runner.refit_models(s, models);
  if (!models.empty() && !session.should_stop())
    result.advice = runner.advise(result.soils.front(), open_contenders(result));
  display.finish();

  // 3. write
  context.num_simulations = ledger.num_done;
  context.num_failed = ledger.failures.size();
  write_file(folder / "diagnosis.json", diagnosis_json(result, context));
  write_file(folder / "diagnosis.txt", diagnosis_text(result, context));
  for (const std::string& why : draw_diagnosis(result, folder / "figures")) std::cerr << "no figure " << why << '\n';
  if (o.apply && !session.should_stop())
    for (const std::string& line : write_extended_fits(result, context, session.context(), folder)) std::cerr << line << '\n';
  write_file(folder / "timing.json", session.timing_json(command_line));
  std::cout << verdict_sentence(result) << '\n' << fmt::format("results: {} ({:.0f} s)\n", folder.string(), session.seconds());
  if (session.should_stop()) {
    std::cerr << session.stop_reason() << ": the report says what is known so far; go on with --resume\n";
    return exit_budget;
  }
  if (too_many_failed(ledger)) {
    std::cerr << fmt::format("{} of {} simulations failed, the first: {}\n", ledger.failures.size(), ledger.num_done,
                             ledger.failures.front().message);
    return exit_failed_runs;
  }
  return exit_done;
}

}  // namespace tilth
