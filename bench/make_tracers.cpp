// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Synthetic tracers for a soil: a sweep in a bed of finer aggregates than a fit uses, on other packings,
// with noise of a survey. Prints tracers.csv (a minute or two per packing). From the repository's root:
//
//     build/release/bin/make_tracers loamy_sand bond_modulus_Pa=4e6 bond_tensile_strength_Pa=5e3 friction=0.45
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/csv_table.hpp"
#include "calibrate/parallel.hpp"
#include "tests/calibrate/formula_models.hpp"

namespace {

using namespace tilth;

constexpr double radius_m = 0.0145;       ///< a fit confirms with 18 mm
constexpr std::uint64_t packings[] = {700'001, 700'002};
constexpr double survey_sd_m = 0.01;      ///< of every coordinate
constexpr double held_out_depth_m = 0.05;

SoilMaterial truth_of(const SoilData& soil, const std::vector<std::string>& settings) {
  Eigen::VectorXd values = nominal_values(soil);
  for (const std::string& setting : settings) {
    const auto equals = setting.find('=');
    const auto number = parse_finite_number(setting.substr(std::min(setting.size(), equals + 1)));
    bool known = false;
    for (std::size_t k = 0; k < soil.parameters.size(); ++k)
      if (number && soil.parameters[k].id == setting.substr(0, equals)) {
        values[static_cast<Eigen::Index>(k)] = *number;
        known = true;
      }
    if (!known) throw ConfigError({setting + ": no parameter=number of the soil"});
  }
  return material_of(soil, values);
}

const std::vector<std::vector<double>>& rows_of(const ExperimentResult& r, const std::string& curve) {
  return std::ranges::find(r.curves, curve, &Curve::name)->rows;
}

/// Standard deviation of single tracers about the mean of their site, all coordinates and sites pooled.
double pooled_sd_m(const std::vector<ExperimentResult>& runs) {
  double sum_m2 = 0.0, freedom = 0.0;
  for (const ExperimentResult& r : runs)
    for (const std::vector<double>& site : rows_of(r, "tracer_means")) {
      const double n = site[2];
      if (n < 2) continue;
      for (const std::size_t sd : {6U, 7U, 8U}) sum_m2 += (n - 1) * site[sd] * site[sd];
      freedom += 3 * (n - 1);
    }
  return std::sqrt(sum_m2 / freedom);
}

void print_tracers(const std::vector<ExperimentResult>& runs, const std::string& source) {
  fmt::print("plotId,tracerId,initial_depth_m,initial_lateral_m,forward_m,lateral_m,vertical_m,sigma_m,"
             "holdout,provenance,source\n");
  const double sigma_m = std::hypot(pooled_sd_m(runs), survey_sd_m);
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const std::vector<double>& t : rows_of(runs[k], "tracers")) {
      const auto noise = [&](std::uint64_t axis) {
        return survey_sd_m * test::normal_number(packings[k], static_cast<std::uint64_t>(t[0]), axis);
      };
      fmt::print("sweep_bin,{}-{:.0f},{:g},{:g},{:.4f},{:.4f},{:.4f},{:.3f},{},synthetic,\"{}\"\n", k + 1,
                 t[0], t[1], t[2], t[4] + noise(0), t[5] + noise(1), t[6] + noise(2), sigma_m,
                 t[1] == held_out_depth_m ? 1 : 0, source);
    }
}

int run(const std::string& soil_id, const std::vector<std::string>& settings) {
  const SoilData soil = load_soil(std::string(TILTH_SOURCE_DIR) + "/data/soils/" + soil_id);
  const SoilMaterial material = truth_of(soil, settings);
  PackingStore store(default_packing_folder());
  std::vector<ExperimentResult> runs(std::size(packings));
  parallel_for_each_index(runs.size(), threads_or_all(0), [&](std::size_t k) {
    TestConfig test = virtual_test("sweep_tillage", Fidelity::confirm);
    apply_soil_state(test, soil);
    set_packing_seed(test, packings[k]);
    auto& sweep = std::get<SweepTillageConfig>(test);
    sweep.particle_radius_m = radius_m;
    runs[k] = run_sweep_tillage(std::span(&material, 1), sweep, store).front();
  });
  for (const ExperimentResult& r : runs)
    if (r.status != RunStatus::completed) throw std::runtime_error(r.message);
  print_tracers(runs, fmt::format("bench/make_tracers; aggregates of {} mm radius; packings {}; survey noise {} mm; truth {}",
                                  1e3 * radius_m, fmt::join(packings, " and "), 1e3 * survey_sd_m, fmt::join(settings, " ")));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw ConfigError({"usage: make_tracers SOIL [parameter=number ...]"});
    return run(argv[1], std::vector<std::string>(argv + 2, argv + argc));
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
}
