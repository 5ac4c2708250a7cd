// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The catalogue of effects against the model it speaks of: names, bounds, null values, lanes, the command.
#include <algorithm>
#include <set>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/virtual_test.hpp"
#include "calibrate/effect_catalogue.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/soil_vocabulary.hpp"
#include "tests/cli/program_run.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using namespace tilth::testing;

namespace {

SoilMaterial loam() {
  SoilMaterial m = bonded_soil();
  m.bond.tensile_strength_Pa = 4e3;
  m.bond.cohesion_Pa = 6e3;
  return m;
}

TestConfig small_test(const std::string& id) {
  TestConfig test = virtual_test(id, Fidelity::preview);
  const std::vector<Field> settings = fields(test);
  const auto set = [&](const char* name, std::vector<double> values) {
    if (const Field* f = find_field(settings, name)) set_numbers(*f, values);
  };
  set("num_particles", {120});
  set("normal_stress_Pa", {10e3});
  set("fast_rate_ratio", {4});
  set("depth_m", {0.01});
  set("max_shear_strain", {0.03});
  set("max_slide_over_length", {0.02});
  set("max_rotation_rad", {0.1});
  if (id == "cone_penetration") {
    set("speed_m_per_s", {0.4});
    set("base_diameter_m", {0.02});
  }
  return test;
}

/// The quick ones; a sweep has a test of its own, prepared triaxial tests too.
const std::vector<std::string> quick_tests = {"unconfined_compression", "direct_shear",
                                              "confined_compression",   "direct_tension",
                                              "interface_shear",        "cone_penetration",
                                              "vane_shear"};

double& number(SoilMaterial& material, std::string_view name) {
  const std::vector<Field> names = fields(material);
  const Field* field = find_field(names, name);
  REQUIRE(field != nullptr);
  return *std::get<double*>(field->value);
}

/// Every parameter of the catalogue at its null value, or at its typical size.
SoilMaterial with_every(SoilMaterial m, bool typical) {
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) number(m, p.name) = typical ? p.typical : p.null_value;
  return m;
}

}  // namespace

TEST_CASE("Effects: the catalogue and the material agree on names, null values and ranges", "[cli][effects]") {
  const SoilMaterial plain;
  std::set<std::string> listed;
  for (const Effect& e : effect_catalogue()) {
    INFO(e.id);
    for (const EffectParameter& p : e.parameters) {
      INFO(p.name);
      SoilMaterial m;
      REQUIRE(number(m, p.name) == p.null_value);
      const std::vector<Field> names = fields(m);
      const Field* field = find_field(names, p.name);
      CHECK(p.lower >= field->lower);
      CHECK(p.upper <= field->upper);
      REQUIRE(soil_vocabulary().parameter(p.name) != nullptr);
      listed.insert(p.name);
    }
    for (const std::string& test : e.tests)
      CHECK(std::ranges::count(virtual_test_ids(), test) == 1);
  }
  SoilEffects effects;
  for (const Field& f : fields(effects)) CHECK(listed.contains(std::string(f.name)));
}

TEST_CASE("Effects: naming every one at its null value keeps every bit of every test", "[cli][effects]") {
  std::vector<std::string> tests = quick_tests;
  tests.push_back("angle_of_repose");
  for (const std::string& id : tests) {
    INFO(id);
    const TestConfig test = small_test(id);
    const std::vector<SoilMaterial> plain = {loam()}, named = {with_every(loam(), false)};
    require_same(run_virtual_test(test, named, packings(), {}), run_virtual_test(test, plain, packings(), {}));
  }
}

TEST_CASE("Effects: a member beside members with effects keeps its bits, and so does each of them",
          "[cli][effects]") {
  std::vector<SoilMaterial> members = {loam()};
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) {
      if (e.phase == EffectPhase::setup || e.phase == EffectPhase::measurement) continue;
      members.push_back(loam());
      number(members.back(), p.name) = p.typical;
    }
  for (const std::string& id : quick_tests) {
    const TestConfig test = small_test(id);
    const auto single = run_virtual_test(test, members, packings(), with_lanes(1));
    for (const int lanes : {4, 8}) {
      INFO(id << ", " << lanes << " lanes");
      require_same(run_virtual_test(test, members, packings(), with_lanes(lanes)), single);
    }
  }
}

TEST_CASE("Effects: members whose setups differ run on their own packings and keep their order",
          "[cli][effects]") {
  const TestConfig test = small_test("unconfined_compression");
  std::vector<SoilMaterial> members(4, loam());
  members[1].effects.porosity_offset = -0.03;
  members[2].effects.seating_compliance_m_per_Pa = 1e-8;
  members[3].effects.porosity_offset = 0.03;
  const auto r = run_virtual_test(test, members, packings(), {});
  require_same(run_virtual_test(test, {members.data() + 3, 1}, packings(), {}).front(), r[3]);
  CHECK(r[1].feature("secant_modulus_Pa") > r[0].feature("secant_modulus_Pa"));
  CHECK(r[2].feature("secant_modulus_Pa") < r[0].feature("secant_modulus_Pa"));
  CHECK(r[2].feature("peak_stress_Pa") == r[0].feature("peak_stress_Pa"));
  CHECK(r[3].feature("secant_modulus_Pa") < r[0].feature("secant_modulus_Pa"));
}

TEST_CASE("Effects: an impossible setup fails its member alone", "[cli][effects]") {
  TestConfig test = small_test("sweep_tillage");
  std::vector<SoilMaterial> members(1, loam());
  members[0].effects.tool_depth_offset_m = 0.1;  // through the floor
  const auto r = run_virtual_test(test, members, packings(), {});
  CHECK(r[0].status == RunStatus::not_settled);
  CHECK(r[0].message.find("impossible setup") != std::string::npos);
}

TEST_CASE("Effects: a row of parameters.csv makes an effect a parameter of the fit", "[cli][effects]") {
  SoilData soil = load_soil(TILTH_SOURCE_DIR "/data/soils/loamy_sand");
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) {
      SoilParameter row;
      row.id = p.name;
      row.lower = p.lower;
      row.upper = p.upper;
      row.nominal = p.typical;
      row.estimate = true;
      soil.parameters.push_back(row);
    }
  SoilMaterial m = material_of(soil, nominal_values(soil));
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) CHECK(number(m, p.name) == p.typical);
}

TEST_CASE("Effects: mistakes in a catalogue are listed", "[cli][effects]") {
  std::vector<std::string> problems;
  read_effects(effects_json, "effects.json", problems);
  REQUIRE(problems.empty());
  const auto with = [](std::string_view what, std::string_view instead) {
    std::string text(effects_json);
    text.replace(text.find(what), what.size(), instead);
    std::vector<std::string> found;
    read_effects(text, "effects.json", found);
    return found;
  };
  CHECK(with("\"kind\": \"soil\"", "\"kind\": \"soul\"").size() == 1);
  CHECK(with("\"typical\": 0.3", "\"typical\": 30").size() == 1);
  CHECK(with("tool_adhesion_Pa\"", "tool_adhesion_kPa\"").size() == 1);
  CHECK(with("\"id\": \"bond_softening\"", "\"id\": \"rolling_resistance\"").size() == 1);
  CHECK(with("\"law\":", "\"lore\":").size() == 2);  // unknown key, missing key
  CHECK(with("\"side\": \"positive\"", "\"side\": \"left\"").size() == 1);
}

TEST_CASE("calibrate effects: a table, one effect, JSON, and a hint for a wrong name", "[cli][effects]") {
  const ProgramRun table = run({"effects"});
  CHECK(table.exit_code == 0);
  for (const Effect& e : effect_catalogue()) CHECK(table.output.find(e.id) != std::string::npos);
  CHECK(run({"effects", "--json"}).output == effects_json);
  CHECK(run({"effects", "bond_softening"}).output.find("zeta u_c") != std::string::npos);
  const ProgramRun wrong = run({"effects", "bond_softning"});
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.says({"bond_softning", "bond_softening"}));
}

TEST_CASE("calibrate simulate: an effect set by name reaches the result", "[cli][effects]") {
  const TempFolder folder("effects_simulate");
  const auto simulate = [&folder](const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> words = {"simulate", "--experiment", "direct_tension", "--soil", "loamy_sand",
                                      "--quick",  "--out",        folder / name,    "--set",  "num_particles=100"};
    words.insert(words.end(), settings.begin(), settings.end());
    ProgramRun r = run(words);
    r.output = r.output.substr(0, r.output.find("results:"));
    return r;
  };
  const ProgramRun plain = simulate("plain", {});
  CHECK(plain.exit_code == 0);
  CHECK(simulate("null", {"--set", "bond_softening=0"}).output == plain.output);
  CHECK(simulate("soft", {"--set", "bond_softening=2"}).output != plain.output);
  CHECK(simulate("wrong", {"--set", "bond_softening=-1"}).exit_code == 2);
}
