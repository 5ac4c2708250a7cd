// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate twin` and `calibrate diagnose`.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "calibrate/cli/effect_choice.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/extended_fit.hpp"
#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/cli/target_choice.hpp"
#include "calibrate/cli/twin_data.hpp"
#include "calibrate/cli/twin_files.hpp"
#include "calibrate/cli/run_config.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> twin_arguments(const TempFolder& folder, const std::string& name,
                                        const std::vector<std::string>& more) {
  std::vector<std::string> words = {"twin", "--soil", "loamy_sand", "--quick", "--tests", "unconfined_compression,direct_tension",
                                    "--out", folder / name, "--truth", folder / (name + ".json")};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string whole_folder(const fs::path& folder) {
  std::string text;
  for (const auto& file : fs::directory_iterator(folder)) text += soil_test::read_text(file.path());
  return text;
}

SoilData loamy_sand_with_tracers() { return load_soil(soil_test::data_root() / "soils" / "loamy_sand"); }

/// As it is diagnosed where nobody asks for the sweep.
SoilData loamy_sand() {
  SoilData soil = loamy_sand_with_tracers();
  leave_out_sweep(soil);
  return soil;
}

}  // namespace

TEST_CASE("Twin: every mistake is named and nothing is written", "[cli][twin][bad_input]") {
  const TempFolder folder("twin_bad");
  const auto refused = [&](const std::vector<std::string>& more, const std::vector<std::string>& says) {
    const ProgramRun r = run(twin_arguments(folder, "data", more));
    INFO(r.errors);
    CHECK(r.exit_code == exit_bad_input);
    CHECK(r.says(says));
    CHECK_FALSE(fs::exists(folder / "data"));
    CHECK_FALSE(fs::exists(folder / "data.json"));
  };
  refused({"--effect", "roling_resistance=0.3", "--effect", "plastic_contact=7"},
          {"did you mean rolling_resistance", "contact_plasticity must be a number in [0, 0.95]"});
  refused({"--effect", "plastic_contact=0.5", "--effect", "plastic_contact=0.6"}, {"given twice"});
  refused({"--tests", "shear_box"}, {"unknown test 'shear_box'", "direct_shear"});
  const ProgramRun inside = run({"twin", "--soil", "loamy_sand", "--out", folder / "data", "--truth", folder / "data/truth.json"});
  CHECK(inside.exit_code == exit_bad_input);
  CHECK(inside.says({"lies inside the data folder"}));
  const ProgramRun nowhere = run({"twin", "--soil", "loamy_sand"});
  CHECK(nowhere.says({"--out DIR", "--truth FILE"}));
}

TEST_CASE("Twin: the data tell nothing, the truth file tells all, the same command gives the same bytes", "[cli][twin]") {
  const TempFolder folder("twin_data");
  const std::vector<std::string> hidden = {"--effect", "bond_softening=1.5", "--seed", "8123"};
  REQUIRE(run(twin_arguments(folder, "one", hidden)).exit_code == exit_done);
  const std::string data = whole_folder(folder / "one");
  for (const char* word : {"softening", "SOFT", "8123", "effect", "loamy", "quick", "preview"}) {
    INFO(word);
    // parameters.csv is the soil's own, whatever is hidden
    CHECK(soil_test::read_text(folder / "one/measurements.csv").find(word) == std::string::npos);
    CHECK(soil_test::read_text(folder / "one/soil.json").find(word) == std::string::npos);
    CHECK(soil_test::read_text(folder / "one/conditions.csv").find(word) == std::string::npos);
  }
  CHECK(soil_test::read_text(folder / "one/parameters.csv") ==
        soil_test::read_text(soil_test::data_root() / "soils/loamy_sand/parameters.csv"));
  CHECK(data.find("measured") == std::string::npos);
  const TwinTruthFile truth = read_twin_truth(folder / "one.json");
  REQUIRE(truth.effects.size() == 1);
  CHECK(truth.effects[0].id == "bond_softening");
  CHECK(truth.effects[0].value == 1.5);
  CHECK(problems_of_soil_folder(folder / "one").empty());
  const SoilData made = load_soil(folder / "one");
  CHECK(made.targets.size() == 6 * 5);  // four numbers and two, five specimens

  REQUIRE(run(twin_arguments(folder, "two", hidden)).exit_code == exit_done);
  CHECK(soil_test::read_text(folder / "two/measurements.csv") == soil_test::read_text(folder / "one/measurements.csv"));
  REQUIRE(run(twin_arguments(folder, "three", {"--seed", "8123"})).exit_code == exit_done);
  CHECK(soil_test::read_text(folder / "three/measurements.csv") != soil_test::read_text(folder / "one/measurements.csv"));
}

TEST_CASE("Twin: truths are drawn about the nominal values and follow ties", "[cli][twin]") {
  SoilData soil = loamy_sand();
  add_effect_parameters(soil);
  set_laboratory(soil, std::vector<std::string>{"unconfined_compression"});
  TwinPlan plan;
  plan.effects = parse_effects({"rolling_resistance=typical"});
  std::set<double> moduli;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    plan.seed = seed;
    const Eigen::VectorXd v = twin_truth(soil, plan);
    const auto at = [&](const char* id) {
      return v[std::ranges::find(soil.parameters, id, &SoilParameter::id) - soil.parameters.begin()];
    };
    moduli.insert(at("bond_modulus_Pa"));
    CHECK(std::abs(std::log(at("bond_modulus_Pa") / 3e6)) <= 0.2 * std::log(500.0) + 1e-9);
    CHECK(std::abs(at("friction") - 0.5) <= 0.2 * 1.45 + 1e-9);
    CHECK(at("contact_modulus_Pa") == Approx(at("bond_modulus_Pa")));
    CHECK(at("rolling_friction") == 0.3);
    CHECK(at("tool_adhesion_Pa") == 0.0);
  }
  CHECK(moduli.size() == 20);
}

TEST_CASE("Twin: noise has the size that was asked for", "[cli][twin]") {
  // the same specimens with and without noise: the ratio is the noise alone
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, 1};
  TwinPlan plan;
  plan.tests = {"direct_tension"};
  plan.fidelity = Fidelity::preview;
  plan.num_replicates = 16;
  plan.noise = {0.0, 0.0};
  const TwinData clean = make_twin(loamy_sand(), plan, context);
  plan.noise = {0.10, 0.0};
  const TwinData noisy = make_twin(loamy_sand(), plan, context);
  plan.noise = {0.0, 0.10};
  const TwinData tilted = make_twin(loamy_sand(), plan, context);
  REQUIRE(noisy.soil.targets.size() == clean.soil.targets.size());
  double sum = 0.0, squares = 0.0;
  const auto n = static_cast<double>(clean.soil.targets.size());
  for (std::size_t k = 0; k < clean.soil.targets.size(); ++k) {
    const double z = std::log(noisy.soil.targets[k].value / clean.soil.targets[k].value);
    sum += z;
    squares += z * z;
    CHECK(tilted.soil.targets[k].value / clean.soil.targets[k].value ==
          Approx(tilted.soil.targets[0].value / clean.soil.targets[0].value));
  }
  CHECK(std::sqrt(squares / n) == Approx(0.10).epsilon(0.25));  // 32 numbers: 13 % each way
  CHECK(std::abs(sum / n) < 0.06);
}

TEST_CASE("Twin: numbers that may be negative get noise of their own size, the others a factor", "[cli][twin]") {
  SoilData soil = loamy_sand();
  TwinPlan plan;
  plan.tests = chosen_tests({"sweep"});
  plan.num_replicates = 40;
  plan.noise = {0.1, 0.0};
  set_laboratory(soil, plan.tests);
  add_effect_parameters(soil);
  std::vector<Evaluation> runs;
  for (int n = 0; n < plan.num_replicates; ++n) {
    Evaluation e{EvaluationStatus::completed, Eigen::VectorXd(static_cast<Eigen::Index>(soil.targets.size())), ""};
    for (std::size_t k = 0; k < soil.targets.size(); ++k)  // displacements of -20 mm, all else 300
      e.features[static_cast<Eigen::Index>(k)] = soil.targets[k].sigma_kind == SigmaKind::absolute ? -0.02 : 300.0;
    runs.push_back(e);
  }
  const TwinData twin = twin_of(soil, plan, twin_truth(soil, plan), runs);
  REQUIRE(twin.soil.targets.size() == 40 * soil.targets.size());
  double squares = 0.0;
  int num_signed = 0;
  for (const SoilTarget& t : twin.soil.targets) {
    if (t.sigma_kind != SigmaKind::absolute) {
      CHECK(t.value > 0.0);
      CHECK(std::abs(t.sigma - 0.1) < 0.05);
      continue;
    }
    CHECK(std::abs(t.sigma - 0.002) < 0.001);
    squares += std::pow((t.value + 0.02) / 0.002, 2);
    ++num_signed;
  }
  REQUIRE(num_signed == 40 * 18);
  CHECK(squares / num_signed == Approx(1.0).epsilon(0.2));
}

TEST_CASE("Candidates: one per size of the catalogue, active where a test of the soil depends on it", "[cli][diagnosis]") {
  SoilData soil = loamy_sand();
  add_effect_parameters(soil);
  const std::vector<CandidateChoice> choices = candidate_choices(soil);
  const auto find = [&](const char* id) {
    return *std::ranges::find_if(choices, [&](const CandidateChoice& c) { return c.candidate.id == id; });
  };
  CHECK(choices.size() == 28);
  CHECK(find("plastic_contact").step.is_active);
  CHECK_FALSE(find("tool_adhesion").step.is_active);
  SoilData with_sweep = loamy_sand_with_tracers();
  add_effect_parameters(with_sweep);
  CHECK(std::ranges::any_of(candidate_choices(with_sweep), [](const CandidateChoice& c) {
    return c.candidate.id == "tool_adhesion" && c.step.is_active;
  }));
  CHECK(find("particle_size").step.is_costly);
  CHECK(find("particle_size").candidate.typical == 0.3);
  CHECK(find("particle_size").step.step() == -0.3);
  CHECK(find("depth_dependent_strength").step.settings.size() == 2);  // its depth comes with it
  CHECK(find("load_cell_gain").candidate.common_size);
  // null values are the baseline: the same material
  const Eigen::VectorXd nominal = nominal_values(soil);
  const SoilData plain = loamy_sand();
  SoilMaterial with = material_of(soil, nominal), without = material_of(plain, nominal_values(plain));
  const auto a = fields(with), b = fields(without);
  for (std::size_t k = 0; k < a.size(); ++k) CHECK(*std::get<double*>(a[k].value) == *std::get<double*>(b[k].value));
}

TEST_CASE("Diagnose: a small campaign ends in a verdict, a report and figures, and resume gives the same bytes", "[cli][diagnosis]") {
  const TempFolder folder("diagnose");
  REQUIRE(run(twin_arguments(folder, "data", {})).exit_code == exit_done);
  const ProgramRun r = run({"diagnose", "--data", folder / "data", "--quick", "--out", folder / "run"});
  INFO(r.errors);
  REQUIRE(r.exit_code == exit_done);
  const Json card = Json::parse(soil_test::read_text(folder / "run/diagnosis.json"));
  CHECK(card["schema"] == "tilth.diagnosis/1");
  CHECK(card["preview"] == true);
  // the first progress line knows about how many simulations there will be
  const std::size_t said = r.errors.find("of about ");
  REQUIRE(said != std::string::npos);
  const int expected = std::stoi(r.errors.substr(said + 9));
  CHECK(expected > card["num_simulations"].get<int>() / 2);
  CHECK(expected < card["num_simulations"].get<int>() * 3);
  // nothing is hidden: whatever the verdict, it is no name
  INFO(card["sentence"]);
  CHECK(std::set<std::string>{"none", "set", "inconclusive"}.contains(card["verdict"]));
  CHECK(card["effects"].empty());
  // no more is claimed than could have been seen
  const auto& scores = card["soils"][0]["candidates"];
  const auto num_absent = std::ranges::count_if(scores, [](const Json& c) { return c["decision"] == "absent"; });
  CHECK(num_absent < 28);
  if (card["verdict"] == "none")
    CHECK(card["sentence"].get<std::string>().find(std::to_string(num_absent) + " of 28 candidates") != std::string::npos);
  CHECK(card["soils"][0]["numerical_gates"].size() == 4);
  CHECK(card["soils"][0]["candidates"].size() == 28);
  CHECK_FALSE(card["could_not_have_been_seen"].empty());
  for (const Json& pair : card["soils"][0]["look_alikes"]) {
    CHECK(pair["first"] != pair["second"]);
    CHECK(std::abs(pair["correlation"].get<double>()) >= 0.5);
    CHECK(std::abs(pair["correlation"].get<double>()) <= 1.0);
  }
  CHECK(fs::exists(folder / "run/figures/residuals.svg"));
  CHECK(fs::exists(folder / "run/figures/probabilities.svg"));
  const std::string text = soil_test::read_text(folder / "run/diagnosis.txt");
  for (const char* part : {"PREVIEW", "[[Detection]]", "[[Where]]", "[[Candidates]]", "[[Numerical gates]]", "reproduce: calibrate diagnose"})
    CHECK(text.find(part) != std::string::npos);
  const std::string before = soil_test::read_text(folder / "run/diagnosis.json");
  const ProgramRun again = run({"diagnose", "--data", folder / "data", "--quick", "--out", folder / "run", "--resume"});
  CHECK(again.exit_code == exit_done);
  CHECK(soil_test::read_text(folder / "run/diagnosis.json") == before);
  CHECK(Json::parse(soil_test::read_text(folder / "run/timing.json"))["runs_simulated"] == 0);
}

TEST_CASE("Diagnose: the applied model is a fit.json with the effect as a parameter, and ties follow", "[cli][diagnosis]") {
  const TempFolder folder("diagnose_apply");
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, 2};
  TwinPlan plan;
  plan.tests = {"unconfined_compression", "direct_tension"};
  plan.effects = parse_effects({"bond_softening=1"});
  plan.fidelity = Fidelity::preview;
  SoilData made = make_twin(loamy_sand(), plan, context).soil;
  std::erase_if(made.parameters, [](const SoilParameter& p) { return p.group == "effect"; });
  DiagnosisResult result;
  result.soils.push_back(soil_case(made));
  SoilCase& soil = result.soils.front();
  NamedEffect name;
  for (std::size_t k = 0; k < soil.choices.size(); ++k)
    if (soil.choices[k].candidate.id == "bond_softening") name.effect = k;
  name.id = "bond_softening";
  result.diagnosis.effects = {name};
  soil.unit = unit_start(soil.parameters);
  RefittedModel model;
  model.refit.is_usable = true;
  model.refit.unit = soil.unit;
  model.refit.sizes = Eigen::VectorXd::Constant(1, 1.0);
  soil.models = {RefittedModel{}, model};
  DiagnosisContext diagnosis{.settings = diagnosis_settings(true, 1), .command = "calibrate diagnose", .preview = true};
  const auto lines = write_extended_fits(result, diagnosis, context, folder.path());
  REQUIRE(lines.size() == 1);
  const FittedSet fit = read_fit_card(folder / "fit.json");
  const auto value = [&](const char* id) {
    return std::ranges::find(fit.parameters, id, &FittedSet::Value::name)->value;
  };
  const auto added = std::ranges::find(fit.parameters, "bond_softening", &FittedSet::Value::name);
  REQUIRE(added != fit.parameters.end());
  CHECK(added->role != "fixed");
  CHECK(value("contact_modulus_Pa") == Approx(value("bond_modulus_Pa")));
  CHECK(value("bond_cohesion_Pa") == Approx(1.5 * value("bond_tensile_strength_Pa")));
  CHECK(std::ranges::find(fit.parameters, "rolling_friction", &FittedSet::Value::name) == fit.parameters.end());
  CHECK(soil_test::read_text(folder / "fit_report.txt").find("1*bond_modulus_Pa") != std::string::npos);
  // nothing named: nothing written
  result.diagnosis.effects.clear();
  CHECK(write_extended_fits(result, diagnosis, context, folder.path() / "none").front().find("nothing was named") != std::string::npos);
  CHECK_FALSE(fs::exists(folder.path() / "none"));
}

TEST_CASE("Diagnose: data that cannot be diagnosed are refused or answered, never named", "[cli][diagnosis][bad_input]") {
  const TempFolder folder("diagnose_bad");
  CHECK(run({"diagnose"}).exit_code == exit_bad_input);
  CHECK(run({"diagnose", "--soil", "loamysand"}).says({"did you mean loamy_sand"}));
  CHECK(run({"diagnose", "--soil", "all", "--fit", "x"}).says({"--fit is of one soil"}));
  REQUIRE(run(twin_arguments(folder, "data", {"--replicates", "2"})).exit_code == exit_done);
  SECTION("soils that are fitted with other parameters are not pooled") {
    const ProgramRun r = run({"diagnose", "--soil", "all", "--quick", "--max-walltime", "0:00:01", "--out", folder / "all"});
    INFO(r.errors);
    CHECK(r.exit_code == exit_budget);
    CHECK(r.says({"karlsruhe_fine_sand: left out of --soil all", "contact_modulus_Pa"}));
    CHECK_FALSE(r.says({"loamy_sand: left out"}));
  }
  SECTION("the sweep is diagnosed when it is asked for") {
    const auto diagnosed = [&](const std::vector<std::string>& more) {
      std::vector<std::string> words = {"diagnose", "--soil", "loamy_sand", "--quick", "--max-walltime", "0:00:01",
                                        "--out", folder / "run"};
      words.insert(words.end(), more.begin(), more.end());
      const ProgramRun r = run(words);
      CHECK(r.exit_code == exit_budget);
      CHECK(r.says({"loamy_sand: the 45 targets of the sweep are left out; --tests all"}) == more.empty());
      CHECK((soil_test::read_text(folder / "run/diagnosis.txt").find("45 targets of the sweep") != std::string::npos) == more.empty());
      std::set<std::string> tests;
      const Json config = Json::parse(soil_test::read_text(folder / "run/config.json"));
      for (const Json& t : config["soils"][0]["targets"]) {
        const std::string name = t["name"];
        tests.insert(name.substr(0, name.find('/')));
      }
      return tests;
    };
    const std::set<std::string> mechanical = {"confined_compression", "direct_shear", "unconfined_compression"};
    CHECK(diagnosed({}) == mechanical);
    CHECK(diagnosed({"--tests", "mechanical"}) == mechanical);
    CHECK(diagnosed({"--tests", "sweep"}) == std::set<std::string>{"sweep_tillage"});
    CHECK(diagnosed({"--tests", "all"}).size() == 4);
  }
  SECTION("too many failed runs: the report is written, the exit code says so") {
    REQUIRE(run({"twin", "--soil", "loamy_sand", "--quick", "--tests", "confined_compression", "--replicates", "3",
                 "--out", folder / "pressed", "--truth", folder / "pressed.json"}).exit_code == exit_done);
    // At most 50 kPa of modulus carry no 100 kPa before 40 % strain.
    std::string table = soil_test::read_text(folder / "pressed/parameters.csv");
    const std::string usual = "1e5,5e7,3e6";
    REQUIRE(table.find(usual) != std::string::npos);
    table.replace(table.find(usual), usual.size(), "1e4,5e4,2e4");
    soil_test::write_text(folder / "pressed/parameters.csv", table);
    const ProgramRun r = run({"diagnose", "--data", folder / "pressed", "--quick", "--out", folder / "failing"});
    INFO(r.errors);
    CHECK(r.exit_code == exit_failed_runs);
    CHECK(r.says({"simulations failed, the first: confined_compression"}));
    CHECK(fs::exists(folder / "failing/diagnosis.json"));
  }
  SECTION("one test, two numbers: fewer numbers than parameters") {
    std::string table = soil_test::read_text(folder / "data/measurements.csv"), kept;
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with("unconfined_compression")) kept += line + "\n";
    soil_test::write_text(folder / "data/measurements.csv", kept);
    const ProgramRun r = run({"diagnose", "--data", folder / "data", "--quick", "--out", folder / "run"});
    INFO(r.errors);
    REQUIRE(r.exit_code == exit_done);
    const Json card = Json::parse(soil_test::read_text(folder / "run/diagnosis.json"));
    CHECK(card["verdict"] == "inconclusive");
    CHECK(card["effects"].empty());
    CHECK_FALSE(card["reason"].get<std::string>().empty());
  }
  SECTION("everything held out") {
    std::string table = soil_test::read_text(folder / "data/measurements.csv");
    for (std::size_t at = 0; (at = table.find(",1,0,synthetic", at)) != std::string::npos;) table.replace(at, 5, ",1,1,");
    soil_test::write_text(folder / "data/measurements.csv", table);
    const ProgramRun r = run({"diagnose", "--data", folder / "data", "--quick", "--out", folder / "run"});
    CHECK((r.exit_code == exit_bad_input || r.output.find("all targets are held out") != std::string::npos));
  }
}
