// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/laboratory_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calibrate/nearest_name.hpp"

namespace tilth {
namespace {

constexpr const char* sweep_id = "sweep_tillage";

/// One specimen of a test: how it is run and what is read from it.
struct PlannedSpecimen {
  std::string test_id;
  std::string condition_id;
  std::vector<ConditionNumbers> numbers;
  std::vector<std::string> observables;
  bool holdout = false;
  SigmaKind sigma_kind = SigmaKind::log;  // absolute for numbers that may be negative
};

PlannedSpecimen sheared(const char* test, const char* stem, double stress_Pa, std::vector<std::string> observables,
                        bool holdout) {
  return {test, fmt::format("{}_{:.0f}_kPa", stem, stress_Pa / 1e3), {{"normal_stress_Pa", {stress_Pa}}},
          std::move(observables), holdout, SigmaKind::log};
}

std::vector<PlannedSpecimen> element_tests() {
  std::vector<PlannedSpecimen> all = {
      {"unconfined_compression", "unconfined", {{"fast_rate_ratio", {10.0}}},
       {"peak_stress_Pa", "secant_modulus_Pa", "strain_at_peak", "fast_peak_ratio"}},
      {"confined_compression", "oedometer",
       {{"load_from_stress_Pa", {25e3}}, {"load_to_stress_Pa", {100e3}}, {"unload_to_stress_Pa", {25e3}},
        {"second_load_to_stress_Pa", {200e3}}},
       {"constrained_modulus_Pa", "compression_strain", "unload_modulus_Pa", "reload_modulus_Pa",
        "second_unload_modulus_Pa", "radial_stress_ratio"}},
      {"direct_tension", "tension", {}, {"tensile_strength_Pa", "strain_at_peak"}}};
  for (const double stress_Pa : {10e3, 20e3, 40e3, 100e3})
    all.push_back(sheared("direct_shear", "shear", stress_Pa, {"peak_shear_stress_Pa", "residual_shear_stress_Pa"},
                          stress_Pa == 20e3));
  return all;
}

/// Needs a soil whose wall_friction is known: with none the steel slides freely.
std::vector<PlannedSpecimen> steel_tests() {
  std::vector<PlannedSpecimen> all;
  for (const double stress_Pa : {10e3, 40e3, 100e3})
    all.push_back(sheared("interface_shear", "interface", stress_Pa,
                          {"peak_interface_stress_Pa", "residual_interface_stress_Pa"}, stress_Pa == 40e3));
  return all;
}

std::vector<PlannedSpecimen> bed_tests() {
  return {{"cone_penetration", "cone", {}, {"cone_resistance_Pa", "cone_resistance_gradient_Pa_per_m", "pull_out_force_N"}},
          {"vane_shear", "vane", {}, {"vane_strength_Pa", "residual_vane_strength_Pa"}},
          {"angle_of_repose", "heap", {}, {"repose_angle_rad"}}};
}

/// The default sweep at 100 mm and 3.2 km/h; all sites are of one run.
std::vector<PlannedSpecimen> field_tests() {
  const std::vector<ConditionNumbers> pass = {{"tool_depth_m", {0.1}}, {"speed_m_per_s", {0.889}}};
  std::vector<PlannedSpecimen> all = {
      {sweep_id, "sweep", pass, {"draught_N", "furrow_area_m2", "ridge_area_m2", "disturbed_area_m2"}}};
  for (const double depth_m : {0.02, 0.05, 0.08})
    for (const double aside_m : {0.0, 0.05}) {
      PlannedSpecimen site{sweep_id, fmt::format("sweep@{:g}m_{:g}m", depth_m, aside_m), pass,
                           {"forward_displacement_m", "lateral_displacement_m", "vertical_displacement_m"},
                           false, SigmaKind::absolute};
      site.numbers.push_back({"tracer_depth_m", {depth_m}});
      site.numbers.push_back({"tracer_lateral_m", {aside_m}});
      all.push_back(std::move(site));
    }
  return all;
}

std::vector<PlannedSpecimen> laboratory_specimens() {
  std::vector<PlannedSpecimen> all = element_tests();
  for (auto* more : {&steel_tests, &bed_tests})
    for (PlannedSpecimen& s : more()) all.push_back(std::move(s));
  return all;
}

std::vector<PlannedSpecimen> all_specimens() {
  std::vector<PlannedSpecimen> all = laboratory_specimens();
  for (PlannedSpecimen& s : field_tests()) all.push_back(std::move(s));
  return all;
}

std::vector<std::string> tests_of(const std::vector<PlannedSpecimen>& specimens) {
  std::vector<std::string> ids;
  for (const PlannedSpecimen& s : specimens)
    if (std::ranges::find(ids, s.test_id) == ids.end()) ids.push_back(s.test_id);
  return ids;
}

}  // namespace

std::vector<std::string> laboratory_tests() { return tests_of(laboratory_specimens()); }

std::vector<std::string> chosen_tests(const std::vector<std::string>& words) {
  std::vector<std::string> known = laboratory_tests();
  known.emplace_back(sweep_id);
  std::vector<std::string> words_of_choice = {"laboratory", "bed", "all", "sweep"}, chosen, problems;
  words_of_choice.insert(words_of_choice.end(), known.begin(), known.end());
  for (const std::string& word : words) {
    std::vector<std::string> meant = {word};
    if (word == "laboratory") meant = tests_of(element_tests());
    else if (word == "bed") meant = tests_of(bed_tests());
    else if (word == "all") meant = known;
    else if (word == "sweep") meant = {sweep_id};
    else if (std::ranges::find(known, word) == known.end())
      problems.push_back(unknown_name_sentence("test", word, words_of_choice));
    for (const std::string& id : meant)
      if (std::ranges::find(chosen, id) == chosen.end()) chosen.push_back(id);
  }
  if (!problems.empty()) throw ConfigError(problems);
  return chosen;
}

void set_laboratory(SoilData& soil, std::span<const std::string> tests) {
  soil.conditions.clear();
  soil.targets.clear();
  soil.superseded.clear();
  soil.curves.clear();
  for (const PlannedSpecimen& s : all_specimens()) {
    if (std::ranges::find(tests, s.test_id) == tests.end()) continue;
    soil.conditions.push_back({s.condition_id, s.numbers, "", 0});
    for (const std::string& observable : s.observables) {
      SoilTarget t;
      t.test_id = s.test_id;
      t.observable_id = observable;
      t.condition_id = s.condition_id;
      t.sigma = 1.0;
      t.sigma_kind = s.sigma_kind;
      t.holdout = s.holdout;
      t.observation_groups = {s.test_id + "/" + observable + "/" + s.condition_id};
      soil.targets.push_back(t);
    }
  }
}

std::string conditions_csv(const std::vector<TestCondition>& conditions) {
  std::vector<std::string> columns;
  for (const TestCondition& c : conditions)
    for (const ConditionNumbers& n : c.numbers)
      if (std::ranges::find(columns, n.column) == columns.end()) columns.push_back(n.column);
  std::string text = "conditionId";
  for (const std::string& column : columns) text += "," + column;
  text += "\n";
  for (const TestCondition& c : conditions) {
    text += c.id;
    for (const std::string& column : columns) text += fmt::format(",{}", fmt::join(c.values(column), ";"));
    text += "\n";
  }
  return text;
}

}  // namespace tilth
