// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/diagnose/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <tuple>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/csv_table.hpp"
#include "calibrate/sobol_design.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth::scoreboard {
namespace {

constexpr std::uint64_t nominal_packing = 20'001;  ///< the block of packings at the fitted values
constexpr std::uint64_t paired_packing = 30'001;   ///< the block of derivatives
constexpr std::size_t chunk = 48;                  ///< members between two writes
constexpr std::uint64_t design_seed = 7;

using Key = std::tuple<int, int, std::uint64_t, int>;

Key key_of(const LibraryRow& r) { return {static_cast<int>(r.kind), r.point, r.packing, r.candidate}; }

/// All rows of a plan, without numbers, those that share a packing side by side.
std::vector<LibraryRow> planned_rows(const LibraryPlan& plan, const std::vector<CandidateChoice>& choices) {
  std::vector<LibraryRow> rows;
  const auto packing = [](std::uint64_t first, int k) { return first + static_cast<std::uint64_t>(k); };
  for (int k = 0; k < plan.num_nominal_packings; ++k)
    rows.push_back({RowKind::nominal, 0, packing(nominal_packing, k), -1, {}});
  for (int k = 0; k < plan.num_packings; ++k) {
    rows.push_back({RowKind::nominal, 0, packing(paired_packing, k), -1, {}});
    for (int i = 0; i < plan.num_points; ++i)
      rows.push_back({RowKind::design, i, packing(paired_packing, k), -1, {}});
  }
  for (const bool costly : {false, true})
    for (int k = 0; k < (costly ? 1 : plan.num_fingerprint_packings); ++k)
      for (std::size_t c = 0; c < choices.size(); ++c)
        for (int i = 0; i < (costly ? plan.num_costly_points : plan.num_fingerprint_points); ++i)
          if (choices[c].step.is_active && choices[c].step.is_costly == costly)
            rows.push_back({RowKind::fingerprint, i, packing(paired_packing, k), static_cast<int>(c), {}});
  return rows;
}

Eigen::VectorXd physical_row(const Library& library, const LibraryRow& row) {
  const Eigen::VectorXd unit =
      row.kind == RowKind::nominal ? unit_start(library.parameters) : Eigen::VectorXd(library.points.col(row.point));
  Eigen::VectorXd values = physical_point(library.parameters, unit);
  if (row.candidate >= 0)
    for (const auto& [column, value] : library.choices[static_cast<std::size_t>(row.candidate)].step.settings)
      values[column] = value;
  return values;
}

/// First line: what the numbers belong to.
std::string heading(const Library& library, const LibraryPlan& plan) {
  std::string text = fmt::format("# {} {} points, half width {}, statistics", name_of(plan.fidelity), plan.num_points, plan.half_width);
  for (const SoilTarget& t : library.soil.targets) text += fmt::format(" {}.{}@{}", t.test_id, t.observable_id, t.condition_id);
  return text;
}

std::vector<LibraryRow> read_rows(const std::filesystem::path& file, const std::string& expected, std::size_t num_features) {
  std::ifstream in(file);
  std::vector<LibraryRow> rows;
  if (!in) return rows;
  std::string line;
  std::getline(in, line);
  if (line != expected) throw ConfigError({file.string() + ": made for another plan or laboratory; move it away"});
  while (std::getline(in, line)) {
    std::vector<std::string> words;
    for (std::size_t at = 0, end = 0; at <= line.size(); at = end + 1) {
      end = std::min(line.find(',', at), line.size());
      words.push_back(line.substr(at, end - at));
    }
    if (words.size() != 4 + num_features) break;  // the last line of a run that was killed
    LibraryRow r;
    r.kind = static_cast<RowKind>(std::stoi(words[0]));
    r.point = std::stoi(words[1]);
    r.packing = std::stoull(words[2]);
    r.candidate = std::stoi(words[3]);
    r.features.resize(static_cast<Eigen::Index>(num_features));
    for (std::size_t k = 0; k < num_features; ++k)
      r.features[static_cast<Eigen::Index>(k)] = parse_finite_number(words[4 + k]).value_or(std::nan(""));
    rows.push_back(std::move(r));
  }
  return rows;
}

void append(std::FILE* out, const LibraryRow& r) {
  fmt::print(out, "{},{},{},{}", static_cast<int>(r.kind), r.point, r.packing, r.candidate);
  for (const double f : r.features) fmt::print(out, ",{}", f);
  fmt::print(out, "\n");
}

}  // namespace

Library stored_library(const std::filesystem::path& soil_folder, const LibraryPlan& plan,
                       const std::filesystem::path& file, const RunContext& context) {
  Library library;
  library.soil = load_soil(soil_folder);
  const std::vector<std::string> tests = chosen_tests({"laboratory"});
  set_laboratory(library.soil, tests);
  for (SoilTarget& t : library.soil.targets) t.value = 1.0;
  add_effect_parameters(library.soil);
  library.parameters = fit_parameters(library.soil);
  library.choices = candidate_choices(library.soil);
  const Eigen::VectorXd nominal = unit_start(library.parameters);
  library.lower = (nominal.array() - plan.half_width).max(0.02);
  library.upper = (nominal.array() + plan.half_width).min(0.98);
  const Eigen::MatrixXd cube = shifted_sobol_points(plan.num_points, static_cast<int>(nominal.size()), design_seed);
  library.points = (cube.array().colwise() * (library.upper - library.lower).array()).matrix().colwise() + library.lower;

  const std::string first_line = heading(library, plan);
  library.rows = read_rows(file, first_line, library.soil.targets.size());
  std::set<Key> done;
  for (const LibraryRow& r : library.rows) done.insert(key_of(r));
  std::vector<LibraryRow> missing;
  for (const LibraryRow& r : planned_rows(plan, library.choices))
    if (!done.contains(key_of(r))) missing.push_back(r);
  if (missing.empty()) return library;

  std::filesystem::create_directories(file.parent_path());
  {
    // rewritten whole: a half line at its end must not be continued
    std::FILE* out = std::fopen(file.c_str(), "w");
    if (out == nullptr) throw ConfigError({file.string() + ": cannot be written"});
    fmt::print(out, "{}\n", first_line);
    for (const LibraryRow& r : library.rows) append(out, r);
    std::fclose(out);
  }
  const Simulator laboratory =
      dem_simulator(library.soil, plan.fidelity, context, TargetScope::all, FailedTest::leaves_others);
  for (std::size_t begin = 0; begin < missing.size();) {
    // one law at a time: lanes that differ in their laws wait for each other
    std::size_t end = begin;
    while (end < missing.size() && end - begin < chunk && missing[end].packing == missing[begin].packing &&
           missing[end].candidate == missing[begin].candidate)
      ++end;
    Eigen::MatrixXd values(static_cast<Eigen::Index>(library.parameters.size()), static_cast<Eigen::Index>(end - begin));
    std::vector<std::uint64_t> packings;
    for (std::size_t k = begin; k < end; ++k) {
      values.col(static_cast<Eigen::Index>(k - begin)) = physical_row(library, missing[k]);
      packings.push_back(missing[k].packing);
    }
    const std::vector<Evaluation> runs = laboratory(values, packings);
    std::FILE* out = std::fopen(file.c_str(), "a");
    for (std::size_t k = begin; k < end; ++k) {
      LibraryRow& r = missing[k];
      const Evaluation& run = runs[k - begin];
      r.features = run.status == EvaluationStatus::completed
                       ? run.features
                       : Eigen::VectorXd::Constant(static_cast<Eigen::Index>(library.soil.targets.size()), std::nan(""));
      append(out, r);
      library.rows.push_back(r);
    }
    std::fclose(out);
    fmt::print(stderr, "library: {} of {} simulations\n", end, missing.size());
    begin = end;
  }
  return library;
}

}  // namespace tilth::scoreboard
