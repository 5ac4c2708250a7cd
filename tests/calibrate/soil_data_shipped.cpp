// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The soils that come with the project: usable, honest, and equal to the formulas they quote.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "calibrate/soil_data.hpp"
#include "calibrate/soil_fit.hpp"
#include "tests/calibrate/soil_folder.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;

namespace {

SoilData shipped(const std::string& name) {
  return load_soil(soil_folder(soil_test::data_root(), name));
}

double state(const SoilData& soil, const std::string& quantity) {
  const StateQuantity* found = soil.quantity(quantity);
  if (found == nullptr) throw std::logic_error("no state quantity " + quantity);
  return found->value;
}

const SoilTarget& target(const SoilData& soil, const std::string& observable,
                         const std::string& condition = "") {
  for (const SoilTarget& row : soil.targets) {
    const bool same_condition = condition.empty() || row.condition_id == condition;
    if (row.observable_id == observable && same_condition) return row;
  }
  throw std::logic_error("no target " + observable);
}

std::vector<SoilTarget> of_sweep(const SoilData& soil, bool wanted) {
  std::vector<SoilTarget> rows;
  for (const SoilTarget& row : soil.targets)
    if ((row.test_id == "sweep_tillage") == wanted) rows.push_back(row);
  return rows;
}

std::vector<SoilTarget> mechanical(const SoilData& soil) { return of_sweep(soil, false); }

constexpr double head_m = 1.0;                  // 100 cm water
constexpr double suction_Pa = 98.0665 * 100.0;  // of that head

double van_genuchten(double alpha_per_m, double n) {
  return std::pow(1.0 + std::pow(alpha_per_m * head_m, n), -(1.0 - 1.0 / n));
}

/// Effective saturation at 100 cm; for the sandy loam the mean of its two classes.
double saturation(const SoilData& soil) {
  if (soil.id == "coarse_sand") {
    return std::pow(state(soil, "brooks_corey_air_entry_head_m") / head_m,
                    state(soil, "brooks_corey_exponent"));
  }
  if (soil.id == "loamy_sand") {
    return van_genuchten(state(soil, "van_genuchten_alpha_per_m"), state(soil, "van_genuchten_n"));
  }
  return 0.5 * (van_genuchten(state(soil, "van_genuchten_alpha_jb6_per_m"),
                              state(soil, "van_genuchten_n_jb6")) +
                van_genuchten(state(soil, "van_genuchten_alpha_jb7_per_m"),
                              state(soil, "van_genuchten_n_jb7")));
}

/// Slopes dv / d ln p of the four compression functions that docs/data.md lists, pF 2.
struct Slopes {
  std::vector<double> load;    ///< lambda
  std::vector<double> unload;  ///< kappa, only where it is at least 0.05 lambda
};

Slopes slopes(double density_kg_per_m3, double water_content) {
  const double bd = density_kg_per_m3 / 1000.0;
  const double v0 = 2650.0 / density_kg_per_m3;
  const double w = 100.0 * water_content;
  const double osullivan = (2.430 - 0.0055 * (w - 11.2) * (w - 11.2) - 1.572) / 17.0;
  const std::vector<double> lambda = {(-0.182 + 0.212 * v0) / std::numbers::ln10, osullivan,
                                      0.2742 - 0.1749 * bd + 0.0679 * 2.0 - 0.0142 * 4.0,
                                      0.0233 + 0.0728 * 2.0 - 0.0110 * 4.0};
  const std::vector<double> kappa = {
      0.042 / std::numbers::ln10, osullivan * (0.119 - 0.082 * w / 17.0),
      0.056 - 0.044 * bd + 0.019 * 2.0 - 0.0033 * 4.0, 0.0221 * std::exp(std::pow(2.0, -0.4530))};
  Slopes result{lambda, {}};
  for (std::size_t i = 0; i < kappa.size(); ++i) {
    if (kappa[i] >= 0.05 * lambda[i]) result.unload.push_back(kappa[i]);
  }
  return result;
}

struct LogMoments {
  double mean = 0.0;
  double deviation = 0.0;
};

/// Mean and sample deviation of ln M, M = (p2 - p1) v0 / (slope ln(p2/p1)).
LogMoments log_moduli(const std::vector<double>& slope, double v0, const TestCondition& condition) {
  const double from_Pa = *condition.number("load_from_stress_Pa");
  const double to_Pa = *condition.number("load_to_stress_Pa");
  std::vector<double> logs;
  for (const double s : slope) {
    logs.push_back(std::log((to_Pa - from_Pa) * v0 / (s * std::log(to_Pa / from_Pa))));
  }
  LogMoments moments;
  for (const double number : logs) moments.mean += number / static_cast<double>(logs.size());
  double squares = 0.0;
  for (const double number : logs) squares += (number - moments.mean) * (number - moments.mean);
  moments.deviation = std::sqrt(squares / static_cast<double>(logs.size() - 1));
  return moments;
}

// Tables are rounded to four digits: half a unit of the fourth digit is at most 5e-4 of the value,
// and the water content that enters them is itself rounded to 1e-4 (up to 1e-3 of a modulus).
constexpr double table_rounding = 1.5e-3;

/// Their targets are literature and derived numbers; those of the Karlsruhe sand are measured.
const std::vector<std::string> danish_soils = {"coarse_sand", "loamy_sand", "sandy_loam"};

}  // namespace

TEST_CASE("Shipped soils: each loads without a problem", "[calibrate][soil_data]") {
  const std::vector<std::string> names = known_soils(soil_test::data_root());
  REQUIRE(names == std::vector<std::string>{"coarse_sand", "karlsruhe_fine_sand", "loamy_sand",
                                            "sandy_loam"});
  CHECK(problems_of_soil_folder(soil_test::data_root() / "soils/karlsruhe_fine_sand").empty());
  for (const std::string& name : danish_soils) {
    CAPTURE(name);
    CHECK(problems_of_soil_folder(soil_test::data_root() / "soils" / name).empty());
    const SoilData soil = shipped(name);
    CHECK(soil.id == name);
    CHECK(soil.superseded.empty());
    CHECK(soil.warnings == std::vector<std::string>{"no target of the fit is measured"});
  }
}

TEST_CASE("Shipped soils: no target claims to be measured, and the report can say so",
          "[calibrate][soil_data]") {
  for (const std::string& name : danish_soils) {
    const SoilData soil = shipped(name);
    CHECK(measured_share(soil.targets) == 0.0);
    CHECK(provenance_sentence(soil).find("measured targets: 0 of ") == 0);
  }
}

TEST_CASE("Shipped soils: independent observations outnumber free parameters",
          "[calibrate][soil_data]") {
  for (const std::string& name : danish_soils) {
    CAPTURE(name);
    const SoilData soil = shipped(name);
    CHECK(num_free_parameters(soil.parameters) == 3);
    const std::size_t num_mechanical = name == "coarse_sand" ? 5 : 4;
    // two depths times five offsets are fitted, three directions each
    CHECK(num_independent_observations(soil.targets) == num_mechanical + 30);
    CHECK(num_independent_observations(mechanical(soil)) == num_mechanical);
    // The fit core counts distinct groups; both counts must be the same.
    CHECK(num_independent_observations(fit_targets(soil)) ==
          num_independent_observations(soil.targets));
    CHECK(problems(fit_targets(soil)).empty());
    CHECK(problems(fit_parameters(soil)).empty());
  }
}

TEST_CASE("Shipped soils: tracers are synthetic, tell their truth and hold out one depth", "[calibrate][soil_data]") {
  for (const std::string& name : danish_soils) {
    CAPTURE(name);
    const SoilData soil = shipped(name);
    const std::vector<SoilTarget> rows = of_sweep(soil, true);
    REQUIRE(rows.size() == 3 * 5 * 3);  // depths, offsets, directions
    for (const SoilTarget& row : rows) {
      CHECK(row.origin.provenance == Provenance::synthetic);
      for (const char* part : {"bench/make_tracers", "radius", "packings 700001 and 700002", "noise", "truth bond_modulus_Pa="})
        CHECK_THAT(row.origin.source, Contains(part));
      CHECK(row.holdout == (soil.condition(row.condition_id)->number("tracer_depth_m") == 0.05));
    }
    // the truth is one a fit can find
    for (const SoilParameter& p : soil.parameters) {
      const std::string& source = rows.front().origin.source;
      const auto at = source.find(" " + p.id + "=");
      CHECK((at != std::string::npos) == (p.estimate && !p.tied_to));
      if (at == std::string::npos) continue;
      const double truth = std::stod(source.substr(at + p.id.size() + 2));
      CHECK(truth > p.lower);
      CHECK(truth < p.upper);
    }
  }
}

TEST_CASE("Shipped soils: porosity and water content follow from density and retention",
          "[calibrate][soil_data]") {
  for (const std::string& name : danish_soils) {
    CAPTURE(name);
    const SoilData soil = shipped(name);
    const double density = state(soil, "dry_bulk_density_kg_per_m3");
    const double porosity = 1.0 - density / state(soil, "particle_density_kg_per_m3");
    CHECK_THAT(state(soil, "porosity"), WithinAbs(porosity, 5e-5));  // four decimals in the table
    const double residual =
        name == "coarse_sand" ? state(soil, "brooks_corey_residual_water_content") : 0.0;
    const double saturated = name == "coarse_sand"
                                 ? state(soil, "brooks_corey_saturated_water_content")
                                 : state(soil, "water_content_saturated_volumetric");
    const double theta = residual + (saturated - residual) * saturation(soil);
    CHECK_THAT(state(soil, "water_content_drained_volumetric"), WithinAbs(theta, 5.1e-5));
    // 5e-5 of rounding; the sandy loam averages two classes of density 1530 and 1540 (1e-4 more).
    CHECK_THAT(state(soil, "water_content_drained"), WithinAbs(theta * 1000.0 / density, 1.5e-4));
    CHECK_THAT(*soil.condition("shear_drained")->number("suction_Pa"), WithinRel(suction_Pa, 1e-12));
  }
}

TEST_CASE("Shipped soils: cohesion is Se s tan(phi), unconfined strength follows and stands in the fit for it",
          "[calibrate][soil_data]") {
  for (const std::string& name : danish_soils) {
    CAPTURE(name);
    const SoilData soil = shipped(name);
    const double phi_rad = target(soil, "friction_angle_rad").value;
    const SoilTarget& cohesion = target(soil, "cohesion_Pa", "shear_drained");
    CHECK_THAT(cohesion.value,
               WithinRel(saturation(soil) * suction_Pa * std::tan(phi_rad), table_rounding));
    CHECK_THAT(cohesion.sigma, WithinAbs(std::log(3.0), 5e-5));  // a factor 3, four decimals
    const SoilTarget& strength = target(soil, "peak_stress_Pa");
    const double expected = 2.0 * cohesion.value * std::cos(phi_rad) / (1.0 - std::sin(phi_rad));
    CHECK_THAT(strength.value, WithinRel(expected, table_rounding));
    CHECK_FALSE(strength.holdout);
    CHECK(cohesion.holdout);  // one number, used once
    CHECK(strength.observation_groups == std::vector<std::string>{"suction", "friction_angle"});
  }
}

TEST_CASE("Shipped soils: moduli are the geometric mean of the compression functions",
          "[calibrate][soil_data]") {
  for (const std::string& name : danish_soils) {
    CAPTURE(name);
    const SoilData soil = shipped(name);
    const double density = state(soil, "dry_bulk_density_kg_per_m3");
    const Slopes slope = slopes(density, state(soil, "water_content_drained"));
    const TestCondition& condition = *soil.condition("compression_25_100_kPa");
    const LogMoments load = log_moduli(slope.load, 2650.0 / density, condition);
    const LogMoments unload = log_moduli(slope.unload, 2650.0 / density, condition);
    const SoilTarget& loading = target(soil, "constrained_modulus_Pa");
    const SoilTarget& unloading = target(soil, "unload_modulus_Pa");

    CHECK_THAT(unloading.value, WithinRel(std::exp(unload.mean), 4.0 * table_rounding));
    CHECK(unloading.sigma >= std::max(unload.deviation, std::log(2.0)));

    double centre = load.mean;
    double sigma = std::hypot(load.deviation, (unload.mean - load.mean) / std::sqrt(12.0));
    if (name ==
        "coarse_sand") {  // the functions are for loams: a clean loose sand is the other end
      const double youngs_Pa = 7.2e6, poisson = 0.3,
                   k0 = 1.0 - std::sin(33.1 * std::numbers::pi / 180.0);
      const double sand =
          std::log(youngs_Pa * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)) *
                   std::sqrt(k0 * 62.5 / 50.6));
      centre = 0.5 * (load.mean + sand);
      sigma = std::hypot(load.deviation, 0.5 * (sand - load.mean));
    }
    CHECK_THAT(loading.value, WithinRel(std::exp(centre), table_rounding));
    CHECK(loading.sigma >= sigma - 0.005);  // stated to one decimal, rounded up
    CHECK(loading.sigma <= sigma + 0.1);
  }
}

TEST_CASE("Shipped soils: the Keller and Arvidsson pair is plausible per log10 only",
          "[calibrate][soil_data]") {
  const double v0 = 2650.0 / 1472.0;
  const double intercept = -0.007 + 1.196 * v0;
  const double slope = -0.182 + 0.212 * v0;
  const double void_ratio_ln = intercept - slope * std::log(100.0) - 1.0;
  const double void_ratio_log10 = intercept - slope * std::log10(100.0) - 1.0;
  CHECK(void_ratio_ln < 0.3);  // no topsoil packs to a porosity of 0.2 at 100 kPa
  CHECK(void_ratio_log10 > 0.6);
  CHECK(void_ratio_log10 < v0 - 1.0);
}
