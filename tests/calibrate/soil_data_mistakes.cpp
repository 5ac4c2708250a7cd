// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Every mistake a table can hold: named with file and line, alone and all together.
#include <catch2/catch.hpp>

#include "calibrate/soil_data.hpp"
#include "tests/calibrate/soil_folder.hpp"

using namespace tilth;
using tilth::soil_test::mentions;
using tilth::soil_test::SoilFolder;

namespace {

/// One text replaced in a shipped folder, and what one sentence must then say.
struct Mistake {
  std::string name;
  std::string file;
  std::string from;
  std::string to;
  std::vector<std::string> said;
};

const std::string measurements = "measurements.csv";
const std::string parameters = "parameters.csv";
const std::string conditions = "conditions.csv";
const std::string soil_json = "soil.json";

const std::vector<Mistake>& mistakes() {
  static const std::vector<Mistake> all = {
      {"kPa for Pa",
       measurements,
       ",3844,",
       ",3.844,",
       {"measurements.csv:2", "cohesion_Pa = 3.844", "given in kPa? write 3844 Pa"}},
      {"1000 times too large",
       measurements,
       ",1301000,",
       ",1301000000,",
       {"measurements.csv:5", "constrained_modulus_Pa", "1000 times too large"}},
      {"degrees for radians",
       measurements,
       ",0.57596,",
       ",33,",
       {"measurements.csv:3", "given in deg? write 0.575959 rad"}},
      {"negative",
       measurements,
       ",4080000,",
       ",-4080000,",
       {"measurements.csv:6", "must not be negative"}},
      {"not a number",
       measurements,
       ",3844,",
       ",3844 Pa,",
       {"measurements.csv:2", "value = '3844 Pa'", "not a finite number"}},
      {"decimal comma",
       measurements,
       ",3844,",
       ",\"3844,5\",",
       {"measurements.csv:2", "decimal point"}},
      {"nan", measurements, ",3844,", ",nan,", {"measurements.csv:2", "not a finite number"}},
      {"infinity", measurements, ",3844,", ",inf,", {"measurements.csv:2", "not a finite number"}},
      {"value missing", measurements, ",3844,", ",,", {"measurements.csv:2", "value is empty"}},
      {"sigma zero", measurements, ",1.0986,log", ",0,log", {"measurements.csv:2", "sigma = 0"}},
      {"sigma missing",
       measurements,
       ",1.0986,log",
       ",,log",
       {"measurements.csv:2", "sigma is empty"}},
      {"sigma kind",
       measurements,
       "1.0986,log",
       "1.0986,lgo",
       {"measurements.csv:2", "unknown sigma_kind 'lgo'", "did you mean log?"}},
      {"holdout",
       measurements,
       ",1,1,derived,suction",
       ",1,no,derived,suction",
       {"measurements.csv:2", "holdout = 'no': must be 0 or 1"}},
      {"weight",
       measurements,
       ",1,1,derived,suction",
       ",0,1,derived,suction",
       {"measurements.csv:2", "weight = 0"}},
      {"provenance",
       measurements,
       "derived,suction",
       "mesured,suction",
       {"measurements.csv:2", "unknown provenance 'mesured'", "did you mean measured?"}},
      {"test",
       measurements,
       "direct_shear,cohesion_Pa",
       "direct_sheer,cohesion_Pa",
       {"measurements.csv:2", "unknown testId 'direct_sheer'", "did you mean direct_shear?"}},
      {"observable",
       measurements,
       "cohesion_Pa",
       "cohesion_kPa",
       {"measurements.csv:2", "unknown observableId of direct_shear 'cohesion_kPa'",
        "did you mean cohesion_Pa?"}},
      {"condition",
       measurements,
       "cohesion_Pa,shear_drained",
       "cohesion_Pa,shear_draned",
       {"measurements.csv:2", "unknown conditionId 'shear_draned'", "did you mean shear_drained?"}},
      {"x without xId",
       measurements,
       "shear_drained,,,3844",
       "shear_drained,,0.1,3844",
       {"measurements.csv:2", "xId and x belong together"}},
      {"source missing",
       measurements,
       ",unconfined_drained,,,14160,1.1,log,,1,0,derived,"
       "suction;friction_angle,computed from entries of this folder,",
       ",unconfined_drained,,,14160,1.1,log,,1,0,derived,suction;friction_angle,,",
       {"measurements.csv:7", "source is empty"}},
      {"unknown column",
       measurements,
       "locator\n",
       "lokator\n",
       {"measurements.csv:1", "unknown column 'lokator'", "did you mean locator?"}},
      {"missing column",
       measurements,
       ",sigma,",
       ",note,",
       {"measurements.csv:1", "column 'sigma' is missing"}},
      {"too many fields",
       measurements,
       "direct_shear,cohesion_Pa",
       "direct_shear,,cohesion_Pa",
       {"measurements.csv:2", "16 fields, the header has 15 columns"}},
      {"bounds",
       parameters,
       "1e5,5e7,3e6",
       "5e7,1e5,3e6",
       {"parameters.csv:2", "lower = 50000000 must be below upper = 100000"}},
      {"nominal outside",
       parameters,
       "1e5,5e7,3e6",
       "1e5,5e7,3e8",
       {"parameters.csv:2", "nominal = 300000000 must be in"}},
      {"bound missing",
       parameters,
       "1e5,5e7,3e6",
       "1e5,,3e6",
       {"parameters.csv:2", "lower and upper are needed"}},
      {"negative stiffness",
       parameters,
       "1e5,5e7,3e6",
       "-1e5,5e7,3e6",
       {"parameters.csv:2", "lower = -100000 is not possible"}},
      {"negative strength",
       parameters,
       "200,1e5,4000",
       "-200,1e5,4000",
       {"parameters.csv:3", "lower = -200 is not possible"}},
      {"log scale of zero",
       parameters,
       "200,1e5,4000",
       "0,1e5,4000",
       {"parameters.csv:3", "scale log10 needs lower > 0"}},
      {"parameter unit",
       parameters,
       "bond_modulus_Pa,log10",
       "bond_modulus_MPa,log10",
       {"parameters.csv:2", "ends in _MPa", "here _Pa"}},
      {"unknown parameter",
       parameters,
       "friction,lin",
       "fricton,lin",
       {"parameters.csv:4", "unknown parameterId 'fricton'", "did you mean friction?"}},
      {"tie to nothing",
       parameters,
       "1.0*bond_modulus_Pa",
       "1.0*bond_modulus",
       {"parameters.csv:5", "unknown parameter 'bond_modulus'", "did you mean bond_modulus_Pa?"}},
      {"tie in a circle",
       parameters,
       "1.0*bond_modulus_Pa",
       "1.0*contact_modulus_Pa",
       {"parameters.csv:5", "circle: contact_modulus_Pa -> contact_modulus_Pa"}},
      {"tie unreadable",
       parameters,
       "1.5*bond_tensile_strength_Pa",
       "bond_tensile_strength_Pa/2",
       {"parameters.csv:6", "must read like"}},
      {"estimate word",
       parameters,
       "3e6,1,none",
       "3e6,yes,none",
       {"parameters.csv:2", "estimate = 'yes': must be 0 or 1"}},
      {"role",
       parameters,
       "bond,,calibrated",
       "bond,,fixed",
       {"parameters.csv:2", "contradicts role fixed"}},
      {"parameter twice",
       parameters,
       "stiffness_ratio,lin",
       "friction,lin",
       {"parameters.csv:7", "parameterId 'friction' occurs twice"}},
      {"prior",
       parameters,
       "1e5,5e7,3e6,1,none,,",
       "1e5,5e7,3e6,1,log_normal,3e6,0",
       {"parameters.csv:2", "the deviation must be > 0"}},
      {"condition twice",
       conditions,
       "shear_drained_10_kPa",
       "shear_drained",
       {"conditions.csv:4", "conditionId 'shear_drained' occurs twice"}},
      {"condition unit",
       conditions,
       "10000;20000;40000",
       "10;20;40",
       {"conditions.csv:3", "normal_stress_Pa = 10", "given in kPa? write 10000 Pa"}},
      {"two normal stresses",
       conditions,
       "10000;20000;40000",
       "10000;20000",
       {"measurements.csv:2", "at least three", "conditions.csv:3"}},
      {"load upside down",
       conditions,
       ",25000,100000,25000,",
       ",100000,25000,25000,",
       {"measurements.csv:5", "load_from_stress_Pa below load_to_stress_Pa"}},
      {"density in g/cm3",
       conditions,
       "0.191,1450",
       "0.191,1.45",
       {"conditions.csv:2", "bulk_density_kg_per_m3 = 1.45", "write 1450 kg_per_m3"}},
      {"water in percent",
       conditions,
       "0.191,1450",
       "19.1,1450",
       {"conditions.csv:2", "water_content = 19.1", "must be in [0, 1]"}},
      {"JSON cut off",
       soil_json,
       "\"state\": [",
       "\"state\": [[",
       {"soil.json:", "malformed JSON"}},
      {"JSON schema",
       soil_json,
       "tilth.soil/1",
       "tilth.soil/9",
       {"soil.json: /schema", "must be \"tilth.soil/1\""}},
      {"JSON key",
       soil_json,
       "\"name\":",
       "\"nmae\":",
       {"soil.json: /nmae", "unknown key 'nmae'", "did you mean name?"}},
      {"JSON type",
       soil_json,
       "\"value\": 0.115",
       "\"value\": \"0.115\"",
       {"soil.json: /state/0/value = \"0.115\"", "must be a number"}},
      {"JSON provenance",
       soil_json,
       "\"provenance\": \"measured\"",
       "\"provenance\": \"known\"",
       {"soil.json: /state/0/provenance", "unknown word 'known'"}},
      {"state in percent",
       soil_json,
       "\"value\": 0.115",
       "\"value\": 11.5",
       {"soil.json: /state/0/value", "given in percent?"}},
      {"state unit",
       soil_json,
       "dry_bulk_density_kg_per_m3",
       "dry_bulk_density_g_per_cm3",
       {"soil.json: /state/5/quantity", "here _kg_per_m3"}},
  };
  return all;
}

}  // namespace

TEST_CASE("Mistakes: each class alone is named with its file and line", "[calibrate][soil_data]") {
  for (const Mistake& mistake : mistakes()) {
    SoilFolder folder("loamy_sand", "one_mistake");
    folder.replace(mistake.file, mistake.from, mistake.to);
    const std::vector<std::string> found = problems_of_soil_folder(folder.path());
    CAPTURE(mistake.name, mistake.said, found);
    CHECK(mentions(found, mistake.said));
  }
}

TEST_CASE("Mistakes: a missing file or folder is named", "[calibrate][soil_data]") {
  for (const std::string& file : {measurements, parameters, conditions, soil_json}) {
    SoilFolder folder("loamy_sand", "missing_file");
    std::filesystem::remove(folder.path() / file);
    CHECK(mentions(problems_of_soil_folder(folder.path()), {file, "missing"}));
  }
  CHECK(mentions(problems_of_soil_folder("/nowhere/at/all"), {"/nowhere/at/all: no such folder"}));
}

TEST_CASE("Mistakes: a row written twice is named, replicates are not", "[calibrate][soil_data]") {
  SoilFolder folder("loamy_sand", "duplicate");
  const std::string row =
      "direct_shear,cohesion_Pa,shear_drained,,,4000,0.5,log,,1,0,derived,a,b,c";
  folder.append(measurements, row);
  CHECK(mentions(problems_of_soil_folder(folder.path()),
                 {"measurements.csv:8", "the same as line 2"}));
}

TEST_CASE("Mistakes: many at once are all listed, over all files", "[calibrate][soil_data]") {
  SoilFolder folder("loamy_sand", "many");
  std::vector<std::vector<std::string>> expected;
  // only mistakes that do not touch the same text
  for (const std::string name :
       {"kPa for Pa", "sigma kind", "negative", "1000 times too large", "source missing", "bounds",
        "negative strength", "tie to nothing", "tie unreadable", "role", "condition twice",
        "condition unit", "JSON schema", "JSON key", "JSON type"}) {
    for (const Mistake& mistake : mistakes()) {
      if (mistake.name != name) continue;
      folder.replace(mistake.file, mistake.from, mistake.to);
      expected.push_back(mistake.said);
    }
  }
  REQUIRE(expected.size() == 15);
  try {
    load_soil(folder.path());
    FAIL("load_soil accepted a folder full of mistakes");
  } catch (const ConfigError& error) {
    CHECK(error.sentences().size() >= expected.size());
    for (const auto& said : expected) {
      CAPTURE(said, error.what());
      CHECK(mentions(error.sentences(), said));
    }
  }
}

TEST_CASE("Mistakes: an unknown soil lists the known ones and the nearest",
          "[calibrate][soil_data]") {
  try {
    soil_folder(soil_test::data_root(), "loamysand");
    FAIL("an unknown soil was accepted");
  } catch (const ConfigError& error) {
    CHECK(error.sentences() ==
          std::vector<std::string>{"unknown soil 'loamysand': known are coarse_sand, "
                                   "karlsruhe_fine_sand, loamy_sand, "
                                   "sandy_loam; did you mean loamy_sand?"});
  }
}
