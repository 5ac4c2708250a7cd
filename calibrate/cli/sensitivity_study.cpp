// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/sensitivity_study.hpp"

#include <fmt/format.h>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/file_hash.hpp"
#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/cli/sensitivity_card.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/target_choice.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

using Problems = std::vector<std::string>;

constexpr int default_packings = 8;
constexpr int quick_packings = 3;

void append(const Problems& more, Problems& problems) {
  problems.insert(problems.end(), more.begin(), more.end());
}

void read_soil(const SensitivityCommandOptions& o, SensitivityStudy& study) {
  const std::filesystem::path folder = chosen_soil_folder(o.soil, o.soil_folder);
  study.soil = load_soil(folder);
  study.inputs = soil_tables(folder);
  if (!o.config.empty()) {
    FitOptions not_used;
    apply_run_config(o.config, study.soil, not_used);
    study.inputs.emplace_back(o.config);
  }
  if (!study.tests.empty()) set_laboratory(study.soil, study.tests);
  const bool is_plain_preview = study.tests.empty() && study.fidelity == Fidelity::preview;
  const std::size_t num_left_out = is_plain_preview ? leave_out_sweep(study.soil) : 0;  // as in a fit
  (void)material_of(study.soil, nominal_values(study.soil));
  (void)plan_tests(study.soil, study.fidelity);
  study.parameters = fit_parameters(study.soil);
  study.targets = fit_targets(study.soil);
  study.provenance = study.tests.empty()
                         ? provenance_sentence(study.soil)
                         : "nothing measured is compared: features of tests chosen with --tests";
  if (num_left_out > 0)
    study.provenance += fmt::format("; this preview leaves out the {} targets of the sweep, whose features --tests sweep has", num_left_out);
}

void read_method(const SensitivityCommandOptions& o, SensitivityOptions& options,
                 Problems& problems) {
  const std::vector<std::string> known = {"morris", "sobol"};
  if (o.method.empty()) {
    problems.emplace_back("--method is missing: morris or sobol");
  } else if (o.method != "morris" && o.method != "sobol") {
    problems.push_back("--method: " + unknown_name_sentence("method", o.method, known));
  } else if (o.emulator && o.method == "morris") {
    problems.emplace_back("--emulator: goes with --method sobol only");
  }
  options.method = o.emulator            ? SensitivityMethod::emulator
                   : o.method == "sobol" ? SensitivityMethod::sobol
                                         : SensitivityMethod::morris;
}

void read_new_study(const SensitivityCommandOptions& o, SensitivityStudy& study,
                    Problems& problems) {
  SensitivityOptions& options = study.options;
  read_method(o, options, problems);
  try {
    if (!o.tests.empty()) study.tests = chosen_tests(o.tests);
  } catch (const ConfigError& e) {
    append(e.sentences(), problems);
  }
  study.fidelity = o.quick ? Fidelity::preview : Fidelity::search;
  options.num_rows = o.samples.value_or(default_num_rows(options.method, o.quick));
  options.levels = o.levels.value_or(options.levels);
  options.packings = {o.seed.value_or(1),
                      o.packings.value_or(o.quick ? quick_packings : default_packings)};
}

/// An option that is given must say what the extended study says.
template <typename Given, typename Saved>
void must_agree(const char* option, const Given& given, const Saved& saved, Problems& problems) {
  if (given != saved)
    problems.push_back(
        fmt::format("{} {}: the study in --out has {}; it cannot change", option, given, saved));
}

SensitivityMethod method_of(const SavedStudy& saved) {
  for (const auto method :
       {SensitivityMethod::morris, SensitivityMethod::sobol, SensitivityMethod::emulator})
    if (saved.method == to_string(method)) return method;
  throw ConfigError({"sensitivity.json: unknown method '" + saved.method + "'"});
}

void read_extended_study(const SensitivityCommandOptions& o, const SavedStudy& saved,
                         SensitivityStudy& study, Problems& problems) {
  SensitivityOptions& options = study.options;
  options.method = method_of(saved);
  options.levels = saved.levels;
  options.packings = {saved.seed, saved.num_packings};
  options.num_rows = o.samples.value_or(2 * saved.num_rows);
  study.tests = saved.tests;
  if (!o.tests.empty() && chosen_tests(o.tests) != saved.tests)
    problems.emplace_back("--tests: the study in --out is of other tests; they cannot change");
  study.fidelity = saved.preview ? Fidelity::preview : Fidelity::search;
  if (!o.method.empty()) {
    const std::string kept = options.method == SensitivityMethod::morris ? "morris" : "sobol";
    must_agree("--method", o.method, kept, problems);
  }
  must_agree("--levels", o.levels.value_or(saved.levels), saved.levels, problems);
  must_agree("--packings", o.packings.value_or(saved.num_packings), saved.num_packings, problems);
  must_agree("--seed", o.seed.value_or(saved.seed), saved.seed, problems);
  if (o.quick && !saved.preview) problems.emplace_back("--quick: the study in --out is no preview");
  if (o.emulator && options.method != SensitivityMethod::emulator)
    problems.emplace_back("--emulator: the study in --out is of runs, not of an emulator");
  if (options.num_rows <= saved.num_rows)
    problems.push_back(fmt::format("--samples {}: the study in --out has {}; give more",
                                   options.num_rows, saved.num_rows));
}

/// The first rows of an extension are the old ones only if nothing they depend on has changed.
void check_inputs(const SavedStudy& saved, const SensitivityStudy& study, Problems& problems) {
  std::vector<std::pair<std::string, std::string>> now;
  for (const auto& file : study.inputs)
    now.emplace_back(file.filename().string(), sha256_of_file(file));
  if (saved.soil_id == study.soil.id && now == saved.inputs) return;
  problems.push_back(fmt::format(
      "--extend: soil ({}) or input files (soil tables, --config) are not those of the study in "
      "--out ({}); start a new one",
      study.soil.id, saved.soil_id));
}

void check_options(const SensitivityCommandOptions& o, SensitivityStudy& study, Problems& found) {
  append(problems(o.session), found);
  if (o.max_runs) study.options.max_simulations = *o.max_runs;
  // Without a soil the rest is still checked, against one free parameter.
  std::vector<Parameter> any(1);
  any.front().name = "any";
  append(problems(study.parameters.empty() ? any : study.parameters, study.options), found);
}

}  // namespace

SensitivityStudy read_study(const SensitivityCommandOptions& o) {
  SensitivityStudy study;
  Problems found;
  std::optional<SavedStudy> saved;
  const auto collect = [&found](const auto& step) {
    try {
      step();
    } catch (const ConfigError& e) {
      append(e.sentences(), found);
    }
  };
  if (o.extend && o.session.out.empty())
    throw ConfigError({"--extend: --out is missing, the run folder of the study"});
  if (o.extend) {
    collect([&] { saved = read_saved_study(o.session.out); });
    if (saved) collect([&] { read_extended_study(o, *saved, study, found); });
  } else {
    read_new_study(o, study, found);
  }
  collect([&] { read_soil(o, study); });
  if (saved && !study.parameters.empty()) check_inputs(*saved, study, found);
  check_options(o, study, found);
  if (!found.empty()) throw ConfigError(found);
  return study;
}

}  // namespace tilth
