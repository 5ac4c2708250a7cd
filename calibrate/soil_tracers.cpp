// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// tracers.csv: displacements of single tracers become targets of the sweep test, one per site.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "calibrate/csv_table.hpp"
#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

constexpr const char* test_name = "sweep_tillage";
constexpr double deepest_m = 1.0;        ///< of a tracer
constexpr double farthest_aside_m = 2.0;

/// A displacement column of tracers.csv and the observable it is.
struct Direction {
  const char* column;
  const char* observable;
};
constexpr std::array<Direction, 3> directions = {{{"forward_m", "forward_displacement_m"},
                                                  {"lateral_m", "lateral_displacement_m"},
                                                  {"vertical_m", "vertical_displacement_m"}}};

struct TracerRow {
  std::array<double, 3> moved_m{};
  double sigma_m = 0.0;
  bool holdout = false;
  Origin origin;
  std::size_t line = 0;
};

/// Plot, depth, offset.
using Site = std::tuple<std::string, double, double>;

void check_range(CsvRowReader& row, const char* column, double value, double lower, double upper) {
  if (value >= lower && value <= upper) return;
  row.problem(fmt::format("{} = {}: must be in [{}, {}]{}", column, value, lower, upper,
                          unit_hint(column, value, lower, upper)));
}

std::string plot_of(CsvRowReader& row, const SoilData& soil) {
  const std::string plot = row.text("plotId");
  if (plot.empty() || soil.condition(plot)) return plot;
  std::vector<std::string> known;
  for (const TestCondition& c : soil.conditions) known.push_back(c.id);
  row.problem(unknown_name_sentence("plotId", plot, known) + " (conditions.csv)");
  return "";
}

/// Reads every cell even when an early one is wrong, so that all mistakes of a row are listed.
std::optional<std::pair<Site, TracerRow>> read_row(CsvRowReader& row, const SoilData& soil,
                                                   const SoilVocabulary& vocabulary) {
  TracerRow tracer;
  tracer.line = row.line();
  const std::string plot = plot_of(row, soil);
  const auto depth_m = row.number("initial_depth_m");
  const auto aside_m = row.number("initial_lateral_m");
  if (depth_m) check_range(row, "initial_depth_m", *depth_m, 0.0, deepest_m);
  if (aside_m) check_range(row, "initial_lateral_m", *aside_m, -farthest_aside_m, farthest_aside_m);
  bool whole = !plot.empty() && depth_m && aside_m;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const auto moved_m = row.number(directions[k].column);
    whole = whole && moved_m;
    const KnownObservable* known = vocabulary.observable(test_name, directions[k].observable);
    if (!moved_m || !known) continue;
    tracer.moved_m[k] = *moved_m;
    check_range(row, directions[k].column, *moved_m, known->plausible_lower, known->plausible_upper);
  }
  tracer.sigma_m = row.number("sigma_m").value_or(0.0);
  if (!(tracer.sigma_m > 0.0)) row.problem(fmt::format("sigma_m = {}: must be > 0", tracer.sigma_m));
  tracer.holdout = row.flag("holdout").value_or(false);
  const std::string word = row.choice("provenance", "provenance", provenance_words());
  tracer.origin = {provenance_from_word(word).value_or(Provenance::synthetic), row.text("source"),
                   row.optional_text("locator")};
  if (!whole) return std::nullopt;
  return std::pair{Site{plot, *depth_m, *aside_m}, tracer};
}

/// The condition of one site: that of the plot, and where the tracers lay.
TestCondition site_condition(const TestCondition& plot, const Site& site) {
  TestCondition condition = plot;
  const auto& [name, depth_m, aside_m] = site;
  condition.id = fmt::format("{}@{:.4g}m_{:.4g}m", name, depth_m, aside_m);
  condition.numbers.push_back({"tracer_depth_m", {depth_m}});
  condition.numbers.push_back({"tracer_lateral_m", {aside_m}});
  return condition;
}

/// The mean of a site's tracers; its sigma by the errors of the single ones.
SoilTarget site_target(const TestCondition& condition, const std::vector<TracerRow>& tracers,
                       std::size_t direction) {
  SoilTarget target;
  target.test_id = test_name;
  target.observable_id = directions[direction].observable;
  target.condition_id = condition.id;
  target.line = tracers.front().line;
  target.holdout = tracers.front().holdout;
  target.origin = tracers.front().origin;
  double variance_m2 = 0.0;
  const auto n = static_cast<double>(tracers.size());
  for (const TracerRow& t : tracers) {
    target.value += t.moved_m[direction] / n;
    variance_m2 += t.sigma_m * t.sigma_m / (n * n);
    if (t.origin.provenance > target.origin.provenance) target.origin = t.origin;
  }
  target.sigma = std::sqrt(variance_m2);
  target.origin.locator += fmt::format("{}mean of {} tracers, tracers.csv from line {}",
                                       target.origin.locator.empty() ? "" : "; ", tracers.size(), target.line);
  target.observation_groups = {label(target)};
  return target;
}

}  // namespace

void read_tracers(const std::filesystem::path& file, const SoilVocabulary& vocabulary, SoilData& soil,
                  std::vector<std::string>& problems) {
  if (!std::filesystem::exists(file)) return;
  const CsvTable table = read_csv(
      file,
      {{"plotId", "tracerId", "initial_depth_m", "initial_lateral_m", "forward_m", "lateral_m",
        "vertical_m", "sigma_m", "holdout", "provenance", "source"},
       {"locator"}},
      problems);
  std::map<Site, std::vector<TracerRow>> sites;
  std::set<std::pair<std::string, std::string>> seen;
  for (const CsvRow& record : table.rows) {
    CsvRowReader row(table, record, problems);
    const auto read = read_row(row, soil, vocabulary);
    const std::string tracer = row.text("tracerId");
    if (!read) continue;
    if (!tracer.empty() && !seen.insert({std::get<0>(read->first), tracer}).second)
      row.problem(fmt::format("tracerId '{}' occurs twice in plot '{}'", tracer, std::get<0>(read->first)));
    std::vector<TracerRow>& site = sites[read->first];
    if (!site.empty() && site.front().holdout != read->second.holdout)
      row.problem(fmt::format("holdout differs from line {} of the same site: a site is fitted or held out "
                              "as a whole", site.front().line));
    site.push_back(read->second);
  }
  for (const auto& [site, tracers] : sites) {
    soil.conditions.push_back(site_condition(*soil.condition(std::get<0>(site)), site));
    for (std::size_t k = 0; k < directions.size(); ++k)
      soil.targets.push_back(site_target(soil.conditions.back(), tracers, k));
  }
}

}  // namespace tilth
