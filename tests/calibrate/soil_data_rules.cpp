// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Supersession, independent observations, ties, and the config file on top of the tables.
#include <catch2/catch.hpp>
#include <cmath>

#include "calibrate/fit_config.hpp"
#include "calibrate/soil_data.hpp"
#include "calibrate/soil_fit.hpp"
#include "tests/calibrate/soil_folder.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using tilth::soil_test::mentions;
using tilth::soil_test::SoilFolder;

namespace {

// xId, x and replicateId stay empty; weight 1; a fit target
const std::string measured_cohesion =
    "direct_shear,cohesion_Pa,shear_drained,,,6200,0.2,relative,{},1,0,measured,own_shear,"
    "own laboratory,sheet 7";

std::string replicate(const std::string& id) {
  std::string row = measured_cohesion;
  return row.replace(row.find("{}"), 2, id);
}

std::vector<const SoilTarget*> cohesions(const SoilData& soil) {
  std::vector<const SoilTarget*> rows;
  for (const SoilTarget& target : soil.targets) {
    if (target.observable_id == "cohesion_Pa") rows.push_back(&target);
  }
  return rows;
}

SoilTarget row_of(const std::vector<std::string>& groups, bool holdout = false) {
  SoilTarget target;
  target.observation_groups = groups;
  target.holdout = holdout;
  return target;
}

}  // namespace

TEST_CASE("Supersession: a measured row replaces the derived one without touching code",
          "[calibrate][soil_data]") {
  SoilFolder folder("loamy_sand", "supersede");
  folder.append("measurements.csv", replicate("a"));
  folder.append("measurements.csv", replicate("b"));
  const SoilData soil = load_soil(folder.path());
  const auto rows = cohesions(soil);
  REQUIRE(rows.size() == 2);  // both replicates stay, the derived number goes
  CHECK(rows[0]->origin.provenance == Provenance::measured);
  CHECK(sigma_of(*rows[0]) == 0.2 * 6200.0);
  REQUIRE(soil.superseded.size() == 1);
  CHECK(soil.superseded[0].target.line == 2);
  CHECK(mentions(soil.warnings, {"measurements.csv:2", "superseded by line 8 (measured)"}));
  // q_u was computed from the replaced cohesion; it stays, as an estimate of another kind
  CHECK(mentions(soil.warnings, {"peak_stress_Pa", "compute it anew"}));
  // 6 fitted rows, 2 of them measured; the replicates share a group: 4 observations before, 5 now
  CHECK_THAT(measured_share(soil.targets), WithinAbs(2.0 / 6.0, 1e-15));
  CHECK(num_independent_observations(soil.targets) == 5);
  CHECK(num_independent_observations(fit_targets(soil)) == 5);
}

TEST_CASE("Supersession: another condition supersedes nothing", "[calibrate][soil_data]") {
  SoilFolder folder("loamy_sand", "supersede_other");
  folder.append("conditions.csv", "dry,0.02,1450,,10000;20000;40000,,,,,,own test");
  std::string row = replicate("a");
  folder.append("measurements.csv", row.replace(row.find("shear_drained"), 13, "dry"));
  const SoilData soil = load_soil(folder.path());
  CHECK(soil.superseded.empty());
  CHECK(cohesions(soil).size() == 2);
}

TEST_CASE("Supersession: literature beats derived, derived beats synthetic",
          "[calibrate][soil_data]") {
  SoilFolder folder("loamy_sand", "supersede_order");
  folder.append(
      "measurements.csv",
      "direct_shear,cohesion_Pa,shear_drained,,,5000,0.5,log,,1,0,literature,a,paper,p. 3");
  folder.append(
      "measurements.csv",
      "direct_shear,cohesion_Pa,shear_drained,,,5500,0.5,log,,1,0,synthetic,b,model,run 1");
  const SoilData soil = load_soil(folder.path());
  REQUIRE(cohesions(soil).size() == 1);
  CHECK(cohesions(soil)[0]->value == 5000.0);
  CHECK(soil.superseded.size() == 2);
}

TEST_CASE("Independent observations: a number derived from two others does not count again",
          "[calibrate][soil_data]") {
  CHECK(num_independent_observations({row_of({"c"}), row_of({"phi"})}) == 2);
  CHECK(num_independent_observations({row_of({"c"}), row_of({"phi"}), row_of({"c", "phi"})}) == 2);
  CHECK(num_independent_observations({row_of({"c", "phi"}), row_of({"c"})}) == 2);
  CHECK(num_independent_observations({row_of({"c", "phi"})}) == 1);
  CHECK(num_independent_observations({row_of({"c"}), row_of({"c"}), row_of({"c"})}) == 1);
  CHECK(num_independent_observations({row_of({"c"}), row_of({"phi"}, true)}) == 1);
  CHECK(num_independent_observations(std::vector<SoilTarget>{}) == 0);
}

TEST_CASE("Independent observations: fewer than free parameters is a warning, not an error",
          "[calibrate][soil_data]") {
  SoilFolder folder("loamy_sand", "few");
  folder.replace("measurements.csv", "derived,virgin_compression", "derived,suction");
  folder.replace("measurements.csv", "derived,swelling", "derived,suction");
  const SoilData soil = load_soil(folder.path());
  CHECK(mentions(soil.warnings, {"3 free parameters", "only 2 independent observations"}));
}

TEST_CASE("Sigma: each kind becomes a deviation in the unit of the value",
          "[calibrate][soil_data]") {
  SoilTarget target;
  target.value = 2000.0;
  target.sigma = 0.5;
  CHECK(sigma_of(target) == 0.5);
  target.sigma_kind = SigmaKind::relative;
  CHECK(sigma_of(target) == 1000.0);
  target.sigma_kind = SigmaKind::log;
  const double half_width = 0.5 * (2000.0 * std::exp(0.5) - 2000.0 * std::exp(-0.5));
  CHECK_THAT(sigma_of(target), WithinRel(half_width, 1e-14));  // rounding
}

TEST_CASE("Ties: a tied parameter follows its master, through chains", "[calibrate][soil_data]") {
  CHECK_FALSE(parse_tie("1.5*"));
  CHECK_FALSE(parse_tie("friction+1"));
  CHECK_FALSE(parse_tie("2*3*friction"));
  CHECK_FALSE(parse_tie("nan*friction"));
  REQUIRE(parse_tie(" 1.5 * bond_tensile_strength_Pa "));
  CHECK(parse_tie("friction")->factor == 1.0);

  std::vector<SoilParameter> parameters(3);
  parameters[0].id = "a";
  parameters[0].tied_to = Tie{2.0, "b"};
  parameters[1].id = "b";
  parameters[1].tied_to = Tie{1.5, "c"};
  parameters[2].id = "c";
  const Eigen::VectorXd values = with_ties(parameters, Eigen::Vector3d(9.0, 9.0, 4.0));
  CHECK(values[0] == 12.0);
  CHECK(values[1] == 6.0);
  CHECK(values[2] == 4.0);
}

TEST_CASE("Fit tables: log rows compare logarithms, tied rows are not estimated",
          "[calibrate][soil_data]") {
  const SoilData soil = load_soil(soil_test::data_root() / "soils" / "loamy_sand");
  const std::vector<Target> targets = fit_targets(soil);
  CHECK(targets[0].name == "direct_shear/cohesion_Pa/shear_drained");
  CHECK(targets[0].log_transform);
  CHECK_FALSE(targets[1].log_transform);
  const std::vector<Parameter> parameters = fit_parameters(soil);
  CHECK(free_parameters(parameters) == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("Config: overrides reach the table, mistakes are listed together",
          "[calibrate][soil_data]") {
  const SoilFolder folder("loamy_sand", "config_good");
  SoilData soil = load_soil(folder.path());
  std::vector<std::string> found;
  const JsonDocument good = parse_json(
      R"({"parameters": [{"name": "friction", "value": 0.4},
          {"name": "bond_cohesion_Pa", "estimate": true, "lower": 100, "upper": 1e5},
          {"name": "bond_modulus_Pa", "start": 1e6}],
          "holdout": ["confined_compression/unload_modulus_Pa"]})",
      "good.json", found);
  JsonObjectReader object(good, found);
  apply_fit_config(read_fit_config(object), "good.json", soil, found);
  object.finish();
  CHECK(found == std::vector<std::string>{});
  CHECK_FALSE(soil.parameter("friction")->estimate);
  CHECK(soil.parameter("friction")->nominal == 0.4);
  CHECK_FALSE(soil.parameter("bond_cohesion_Pa")->tied_to);
  CHECK(soil.parameter("bond_modulus_Pa")->nominal == 1e6);
  CHECK(num_independent_observations(soil.targets) == 3);
}

TEST_CASE("Config: an unknown parameter, a bad bound and an unknown target are all named",
          "[calibrate][soil_data]") {
  SoilData soil = load_soil(soil_test::data_root() / "soils" / "loamy_sand");
  std::vector<std::string> found;
  const JsonDocument bad = parse_json(
      R"({"parameters": [{"name": "frction", "start": 0.4},
          {"name": "bond_modulus_Pa", "lower": 1e9},
          {"name": "contact_modulus_Pa", "tied_to": "2*contact_modulus_Pa"},
          {"name": "friction", "value": 0.3, "start": 0.2, "lowr": 1}],
          "holdout": ["direct_shear/cohesion"]})",
      "bad.json", found);
  JsonObjectReader object(bad, found);
  apply_fit_config(read_fit_config(object), "bad.json", soil, found);
  CHECK(
      mentions(found, {"/parameters/0", "unknown parameter 'frction'", "did you mean friction?"}));
  CHECK(mentions(found, {"/parameters/1", "lower = 1000000000", "below upper"}));
  CHECK(mentions(found, {"circle"}));
  CHECK(mentions(found, {"/parameters/3/lowr", "did you mean lower?"}));
  CHECK(mentions(found, {"/parameters/3/value", "contradict"}));
  CHECK(mentions(found, {"/holdout", "unknown target"}));
}
