// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_features.hpp"

#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/measured_features.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/soil_choice.hpp"

namespace tilth {

void add_features_options(CLI::App& command, FeaturesOptions& o) {
  CLI::Option* soil = command.add_option("--soil", o.soil, "soil under data/soils");
  command.add_option("--data", o.soil_folder, "a folder in the soil format, instead of --soil")
      ->excludes(soil);
  command
      .add_option("--fitted", o.fitted,
                  "conditionIds whose rows enter the fit, as TMD2,TMD5; the others are held out")
      ->delimiter(',');
  command.add_option("--source", o.source, "who measured: goes into the column source");
  command.add_option("--out", o.out, "file to write (default: standard output)");
}

int run_features(const FeaturesOptions& o) {
  const SoilData soil = load_soil(chosen_soil_folder(o.soil, o.soil_folder));
  const std::string text = measurements_csv(features_of_curves(soil, o.fitted, o.source));
  if (o.out.empty()) std::cout << text;
  else write_file(o.out, text);
  return exit_done;
}

}  // namespace tilth
