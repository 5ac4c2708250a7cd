// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_check.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/fit_config.hpp"
#include "calibrate/soil_data.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

int check_folder(const std::filesystem::path& folder) {
  const SoilData soil = load_soil(folder);
  (void)material_of(soil, nominal_values(soil));
  (void)plan_tests(soil, Fidelity::search);
  for (const std::string& w : soil.warnings) std::cout << "warning: " << w << '\n';
  for (const SupersededTarget& s : soil.superseded) std::cout << "note: " << s.reason << '\n';
  std::cout << fmt::format("{}: no problems; {}; {} free parameters, {} independent observations\n",
                           folder.string(), provenance_sentence(soil),
                           num_free_parameters(soil.parameters),
                           num_independent_observations(soil.targets));
  return exit_done;
}

/// A config alone: its own keys and types; names are checked against a soil when it is used.
int check_config(const std::filesystem::path& file) {
  std::vector<std::string> problems;
  const JsonDocument document = read_json(file, problems);
  if (!problems.empty()) throw ConfigError(problems);
  JsonObjectReader object(document, problems);
  object.schema("tilth.fit/1");
  (void)read_fit_config(object);
  FitOptions ignored;
  read_fit_options(object, ignored);
  object.finish();
  if (!problems.empty()) throw ConfigError(problems);
  std::cout << file.string() << ": no problems\n";
  return exit_done;
}

}  // namespace

void add_check_options(CLI::App& command, CheckOptions& options) {
  command.add_option("target", options.target, "data folder (data/soils/x) or config file")
      ->required();
}

int run_check(const CheckOptions& options) {
  const std::filesystem::path target = options.target;
  if (std::filesystem::is_directory(target)) return check_folder(target);
  if (!std::filesystem::exists(target))
    throw ConfigError({fmt::format("{}: there is no such folder or file", options.target)});
  return check_config(target);
}

}  // namespace tilth
