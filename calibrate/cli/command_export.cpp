// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/export_decks.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/nearest_name.hpp"

namespace tilth {
namespace {

const std::vector<std::string>& formats() {
  static const std::vector<std::string> known = {"json",   "csv",      "yade",
                                                 "lammps", "liggghts", "pfc"};
  return known;
}

bool is_table(const std::string& format) { return format == "json" || format == "csv"; }

/// Every text of the export, made before any file is.
std::vector<ExportFile> files_of(const ExportOptions& o, const ExportSource& source) {
  if (o.format == "json") return {{"parameters.json", export_json(source)}};
  if (o.format == "csv") return {{"parameters.csv", export_csv(source)}};
  PackingStore packings(default_packing_folder(), solver_version);
  const SoilMaterial& material = source.set.material;
  if (o.format == "yade" || o.format == "pfc") {
    const ExportSpecimen s = bonded_specimen(material, o.num_particles, o.seed, packings);
    return o.format == "yade" ? yade_files(source, s) : pfc_files(source, s);
  }
  const ExportSpecimen s = loose_specimen(material, o.num_particles, o.seed, packings);
  return o.format == "lammps" ? lammps_files(source, s) : liggghts_files(source, s);
}

void check(const ExportOptions& o) {
  if (std::ranges::find(formats(), o.format) == formats().end())
    throw ConfigError({"--format: " + unknown_name_sentence("format", o.format, formats())});
  if (o.num_particles < 50 || o.num_particles > 200'000)
    throw ConfigError({fmt::format("--particles {}: must be in [50, 200000]", o.num_particles)});
}

}  // namespace

void add_export_options(CLI::App& command, ExportOptions& o) {
  command.add_option("FIT", o.fit, "fit.json or the run folder that holds it")->required();
  command.add_option("--format", o.format, "json, csv, yade, lammps, liggghts or pfc");
  command.add_option(
      "--out", o.out,
      "folder (json, csv: default standard output; decks: runs/export-<format>-<n>)");
  command.add_option("--particles", o.num_particles, "spheres of a deck's specimen (default 500)");
  command.add_option("--seed", o.seed, "packing seed of a deck's specimen (default 1)");
}

int run_export(const ExportOptions& o) {
  check(o);
  const ExportSource source = read_export_source(o.fit);
  if (is_table(o.format) && o.out.empty()) {
    std::cout << files_of(o, source).front().text;
    return exit_done;
  }
  const std::filesystem::path folder = make_run_folder(o.out, "export-" + o.format);
  const std::vector<ExportFile> files = files_of(o, source);
  for (const ExportFile& f : files) write_file(folder / f.name, f.text);
  std::cout << folder.string() << ":";
  for (const ExportFile& f : files) std::cout << ' ' << f.name;
  std::cout << '\n';
  return exit_done;
}

}  // namespace tilth
