// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_scale.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/scale_report.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/test_settings.hpp"
#include "calibrate/config_error.hpp"

namespace tilth {
namespace {

using Problems = std::vector<std::string>;

const std::vector<double> default_radii_mm = {20, 16, 12.5, 10, 8};
const std::vector<double> quick_radii_mm = {30, 26, 22};

/// A size limit speaks of the tool, so the bin of `confirm` serves every size; --quick takes the narrower one.
SweepTillageConfig field_test(bool quick) {
  return std::get<SweepTillageConfig>(
      virtual_test("sweep_tillage", quick ? Fidelity::preview : Fidelity::confirm));
}

std::vector<MaterialSource> sources(const ScaleCommandOptions& o) {
  if (o.soil != "all") return {{o.soil, o.soil_folder, o.fit}};
  if (!o.fit.empty()) throw ConfigError({"--fit is of one soil, --soil says all"});
  std::vector<MaterialSource> all;
  for (const std::string& soil : soils_of_all()) all.push_back({soil, "", ""});
  return all;
}

std::string soil_id_of(const MaterialSource& s) {
  if (!s.fit.empty()) return read_fit_card(s.fit).soil_id;
  return chosen_soil_folder(s.soil, s.soil_folder).filename().string();
}

/// "narrow:tool_width_m=0.18:wing_height_m=0.02" -> name and settings.
std::pair<std::string, std::vector<std::string>> parts_of(const std::string& variant) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = variant.find(':', begin);
    parts.push_back(variant.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return {parts.front(), {parts.begin() + 1, parts.end()}};
}

/// Series share settings: each mistake is listed once. @throws ConfigError
void refuse(const Problems& found) {
  Problems once;
  for (const std::string& p : found)
    if (std::ranges::find(once, p) == once.end()) once.push_back(p);
  if (!once.empty()) throw ConfigError(once);
}

/// Every size of a series must be possible.
void check_sizes(const ScaleSeries& series, const std::vector<double>& radii_m, Problems& found) {
  for (const double radius_m : radii_m)
    for (const std::string& p : problems(TestConfig(at_radius(series, radius_m, 1))))
      found.push_back(series.name + ": " + p);
  for (const std::string& p : problems(series.material)) found.push_back(series.name + ": " + p);
}

ScaleSeries series_of(const MaterialSource& source, const ScaleCommandOptions& o, const std::string& variant,
                      Problems& found) {
  TestConfig config = field_test(o.quick);
  SoilMaterial material = starting_material(source, config, found);
  apply_settings("--set", o.settings, config, material, found);
  const std::string soil_id = soil_id_of(source);
  std::string name = soil_id;
  if (!variant.empty()) {
    const auto [label, settings] = parts_of(variant);
    if (label.empty() || settings.empty())
      found.push_back(fmt::format("--variant {}: must be NAME:key=value[:key=value...]", variant));
    apply_settings("--variant " + label, settings, config, material, found);
    name += " " + label;
  }
  return {name, soil_id, std::get<SweepTillageConfig>(config), material};
}

/// The command line that gives the same result, without what does not influence it.
std::string reproducing_command(const ScaleCommandOptions& o, const std::vector<double>& radii_mm, int num_packings) {
  std::string text = "calibrate scale";
  if (!o.soil.empty()) text += " --soil " + o.soil;
  if (!o.soil_folder.empty()) text += " --data " + o.soil_folder;
  if (!o.fit.empty()) text += " --fit " + o.fit;
  text += fmt::format(" --radii {} --packings {} --within {}", fmt::join(radii_mm, ","), num_packings, o.within_percent);
  for (const std::string& s : o.settings) text += " --set " + s;
  for (const std::string& v : o.variants) text += " --variant " + v;
  return text + fmt::format(" --seed {}{}", o.seed, o.quick ? " --quick" : "");
}

struct ScalePlan {
  std::vector<ScaleSeries> series;
  std::vector<double> radii_m;
  int num_packings = 0;
  ScaleContext context;
};

ScalePlan read_plan(const ScaleCommandOptions& o) {
  ScalePlan plan;
  Problems found = problems(o.session);
  std::vector<double> radii_mm = o.radii_mm;
  if (radii_mm.empty()) radii_mm = o.quick ? quick_radii_mm : default_radii_mm;
  std::ranges::sort(radii_mm);
  if (radii_mm.size() < 2 || std::ranges::adjacent_find(radii_mm) != radii_mm.end())
    found.push_back(fmt::format("--radii {}: needs two different sizes at least, each once",
                                fmt::join(radii_mm, ",")));
  for (const double r : radii_mm) plan.radii_m.push_back(1e-3 * r);
  plan.num_packings = o.num_packings > 0 ? o.num_packings : o.quick ? 2 : 3;
  const std::vector<MaterialSource> soils = sources(o);
  for (const MaterialSource& soil : soils) {
    plan.series.push_back(series_of(soil, o, "", found));
    if (soil.fit.empty())
      for (const auto& file : soil_tables(chosen_soil_folder(soil.soil, soil.soil_folder)))
        plan.context.inputs.push_back(file);
    else
      plan.context.inputs.push_back(std::filesystem::is_directory(soil.fit) ? soil.fit + "/fit.json" : soil.fit);
  }
  // variants are about one soil: the first
  for (const std::string& variant : o.variants)
    plan.series.push_back(series_of(soils.front(), o, variant, found));
  if (found.empty())
    for (const ScaleSeries& s : plan.series) check_sizes(s, plan.radii_m, found);
  refuse(found);
  plan.context.values = o.fit.empty() ? "nominal values of data/soils, not fitted" : "fitted values of " + o.fit;
  plan.context.command = reproducing_command(o, radii_mm, plan.num_packings);
  plan.context.preview = o.quick;
  return plan;
}

}  // namespace

void add_scale_options(CLI::App& command, ScaleCommandOptions& o) {
  CLI::Option* soil = command.add_option("--soil", o.soil, "soil under data/soils, or all: those fitted with the same parameters");
  command.add_option("--data", o.soil_folder, "a folder in the soil format, instead of --soil")->excludes(soil);
  command.add_option("--fit", o.fit, "fit.json or run folder: its fitted values instead of the nominal ones");
  command.add_option("--radii", o.radii_mm, "mean radii in mm (default 20,16,12.5,10,8)")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  command.add_option("--packings", o.num_packings, "packings of every size (default 3; 2 with --quick)")
      ->check(CLI::Range(2, 1000));
  command.add_option("--within", o.within_percent, "tolerated difference in percent (default 15)")
      ->check(CLI::Range(0.1, 99.0));
  command.add_option("--set", o.settings, "key=value of the sweep test or the material; may be repeated")->take_all();
  command.add_option("--variant", o.variants,
                     "NAME:key=value:...: one more series with other structure or tool; may be repeated")
      ->take_all();
  command.add_option("--seed", o.seed, "first packing seed (default 1)")->check(CLI::NonNegativeNumber);
  command.add_flag("--quick", o.quick, "a labelled preview: coarse aggregates, two packings");
  add_session_options(command, o.session);
}

int run_scale_command(const ScaleCommandOptions& o, const std::string& command_line) {
  // 1. read and check everything, then open the folder
  const ScalePlan plan = read_plan(o);
  const std::filesystem::path folder =
      open_run_folder(o.session, plan.series.front().soil_id + "-scale", scale_config_json(plan.series, {plan.radii_m, plan.num_packings, o.within_percent / 100, o.seed, o.quick}));
  const RunSession session(o.session, folder);
  if (const std::string note = session.store_note(); !note.empty()) std::cerr << note << '\n';
  std::cerr << fmt::format("{} series x {} sizes x {} packings with {} workers into {}\n", plan.series.size(),
                           plan.radii_m.size(), plan.num_packings, session.num_workers(), folder.string());

  // 2. run
  const std::vector<ScaleResult> results = run_scale(plan.series, plan.radii_m, plan.num_packings, o.seed,
                                                     o.within_percent / 100, session.context());

  // 3. write
  const std::string report = scale_report_text(results, plan.context);
  write_file(folder / "scale.json", scale_json(results, plan.context));
  write_file(folder / "scale.csv", scale_csv(results));
  write_file(folder / "scale_report.txt", report);
  if (const std::string why = draw_scale(results, plan.context, folder / "figures" / "scale.svg"); !why.empty())
    std::cerr << "no figure: " << why << '\n';
  write_file(folder / "timing.json", session.timing_json(command_line));
  std::cout << report << fmt::format("results: {} ({} tests simulated, {} from the store, {:.0f} s)\n",
                                     folder.string(), session.counts().num_simulated,
                                     session.counts().num_from_store, session.seconds());
  if (session.should_stop()) {
    std::cerr << session.stop_reason() << ": the report says what is known so far; go on with --resume\n";
    return exit_budget;
  }
  const bool all_studied = std::ranges::all_of(results, [](const ScaleResult& r) { return r.no_study.empty(); });
  return all_studied ? exit_done : exit_failed_runs;
}

}  // namespace tilth
