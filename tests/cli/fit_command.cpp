// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The main job and `simulate` as a user runs them, on the smallest problem there is.
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/run_config.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using soil_test::read_text;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

Json read(const fs::path& file) { return Json::parse(read_text(file)); }

/// fit.json, every byte of it.
std::string card_of(const fs::path& run_folder) { return read_text(run_folder / "fit.json"); }

std::vector<std::string> tiny_fit(const TempFolder& folder, const std::string& soil,
                                  const std::string& out) {
  return {"--data", soil, "--config", folder.write("fit.json", tiny_config()), "--quick", "--seed",
          "3", "--out", folder / out};
}

}  // namespace

TEST_CASE("Fit: the same command gives the same card on any threads and lanes", "[cli][fit]") {
  const TempFolder folder("same_card");
  const std::string soil = one_test_soil(folder);
  const auto fit = [&](const std::string& threads, const std::string& lanes) {
    std::vector<std::string> arguments = tiny_fit(folder, soil, "t" + threads + "l" + lanes);
    arguments.insert(arguments.end(), {"--threads", threads, "--lanes", lanes});
    const ProgramRun r = run(arguments);
    INFO(r.errors);
    CHECK((r.exit_code == exit_done || r.exit_code == exit_budget ||
           r.exit_code == exit_unreachable || r.exit_code == exit_holdout_failed));
    return folder.path() / ("t" + threads + "l" + lanes);
  };
  const fs::path one = fit("1", "1");
  const std::string card = card_of(one);
  CHECK(card_of(fit("2", "8")) == card);
  CHECK(card_of(fit("2", "1")) == card);

  // The card has what docs promise, and reads back as it was written.
  const Json json = read(one / "fit.json");
  for (const char* key : {"schema", "tool", "inputs", "seed", "status", "message", "soil",
                          "provenance", "parameters", "material", "correlation", "profiles", "equivalence_family", "responses",
                          "fit_statistics", "validation", "scope", "warnings", "failures", "cost",
                          "reproduction"})
    CHECK(json.contains(key));
  CHECK(json["schema"] == "tilth.card/1");
  CHECK(json["inputs"].size() == 5);
  CHECK(json["responses"].size() == 3);
  CHECK(json["fit_statistics"]["effective_sample_sizes"].is_array());
  for (const Json& curve : json["profiles"]["curves"]) {
    const std::string name = curve["name"];
    const std::string table = read_text(one / "profiles" / (name + ".csv"));
    CHECK(table.starts_with(name + ",chi_square_difference,at_bound,"));
    CHECK(std::count(table.begin(), table.end(), '\n') ==
          static_cast<std::ptrdiff_t>(curve["points"].size()) + 1);
  }
  const FittedSet set = read_fit_card(one);
  CHECK(set.soil_id == "loamy_sand");
  CHECK(set.seed == 3);
  CHECK(set.preview);
  CHECK(set.material.friction == 0.5);  // held by the config
  CHECK(set.material.bond.modulus_Pa == json["material"]["bond_modulus_Pa"].get<double>());
  CHECK(set.material.contact_modulus_Pa == set.material.bond.modulus_Pa);  // tied
  CHECK(set.parameters.size() == json["parameters"].size());
  for (const char* file : {"config.json", "log.txt", "fit_report.txt"}) CHECK(fs::exists(one / file));
  CHECK_FALSE(fs::is_empty(one / "curves"));

  // An existing run folder is moved aside, never overwritten.
  fit("1", "1");
  int num_backups = 0;
  for (const auto& entry : fs::directory_iterator(folder.path()))
    if (entry.path().filename().string().starts_with("t1l1.backup-")) {
      ++num_backups;
      CHECK(card_of(entry.path()) == card);
    }
  CHECK(num_backups == 1);
}

TEST_CASE("Fit: Ctrl-C ends it with exit code 3 and a card that says stopped", "[cli][fit]") {
  const TempFolder folder("interrupt");
  // Left alone it would simulate for a minute.
  const std::string config = folder.write("fit.json", R"({"schema": "tilth.fit/1",
      "parameters": [{"name": "friction", "value": 0.5}],
      "fit": {"num_design": 1, "num_noise_seeds": 900}})");
  const ProgramRun r = run_and_signal({"--data", one_test_soil(folder), "--config", config,
                                       "--quick", "--threads", "1", "--out", "run"},
                                      folder.path(), "simulations", SIGINT);
  INFO(r.errors);
  CHECK(r.exit_code == exit_budget);
  const Json card = read(folder.path() / "run" / "fit.json");
  CHECK(card["status"] == "stopped");
  CHECK(card["cost"]["num_simulations"] > 0);
  CHECK(fs::exists(folder.path() / "run" / "fit_report.txt"));
  CHECK_FALSE(fs::exists(folder.path() / "run" / "curves"));
}

TEST_CASE("Fit: too many failed runs end it with exit code 5, each recorded", "[cli][fit]") {
  const TempFolder folder("failures");
  soil_test::SoilFolder soil("loamy_sand", "cli_failures");
  const std::string table = read_text(soil.path() / "measurements.csv");
  std::string kept;  // the header and the confined compression
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);)
    if (kept.empty() || line.starts_with("confined_compression")) kept += line + "\n";
  soil_test::write_text(soil.path() / "measurements.csv", kept);
  // At most 50 kPa of modulus carry no 100 kPa before 40 % strain.
  const std::string config = folder.write("fit.json", R"({"schema": "tilth.fit/1", "parameters": [
      {"name": "bond_modulus_Pa", "lower": 1e4, "upper": 5e4, "start": 2e4},
      {"name": "bond_tensile_strength_Pa", "value": 300}, {"name": "friction", "value": 0.5}],
      "fit": {"num_design": 9}})");
  const ProgramRun r = run({"--data", soil.path().string(), "--config", config, "--quick", "--out",
                            folder / "run"});
  CHECK(r.exit_code == exit_failed_runs);
  const Json card = read(folder.path() / "run" / "fit.json");
  CHECK(card["status"] == "too_many_failures");
  REQUIRE(card["failures"].size() >= 4);
  const Json& failure = card["failures"][0];
  CHECK(failure["message"].get<std::string>().find("reached strain 0.4") != std::string::npos);
  CHECK(failure["parameters"]["bond_modulus_Pa"] <= 5e4);
}

TEST_CASE("Config: it frees, cuts ties and holds out", "[cli][config]") {
  const TempFolder folder("run_config");
  const soil_test::SoilFolder tables("loamy_sand", "run_config");
  SoilData soil = load_soil(tables.path());
  FitOptions options;
  apply_run_config(
      folder.write("fit.json", R"({"schema": "tilth.fit/1",
        "parameters": [
          {"name": "bond_cohesion_Pa", "tied_to": "", "estimate": true, "lower": 300, "upper": 1e5},
          {"name": "contact_modulus_Pa", "tied_to": "0.5*bond_modulus_Pa"},
          {"name": "friction", "value": 0.4}],
        "holdout": ["confined_compression/unload_modulus_Pa"],
        "fit": {"num_design": 64, "max_simulations": 800}})"),
      soil, options);
  CHECK(soil.parameter("bond_cohesion_Pa")->estimate);
  CHECK_FALSE(soil.parameter("bond_cohesion_Pa")->tied_to);
  CHECK(soil.parameter("contact_modulus_Pa")->tied_to->factor == 0.5);
  CHECK_FALSE(soil.parameter("friction")->estimate);
  CHECK(soil.parameter("friction")->nominal == 0.4);
  int num_held_out = 0;
  for (const SoilTarget& t : soil.targets) num_held_out += t.holdout ? 1 : 0;
  CHECK(num_held_out == 3);  // the two of the table and this one
  CHECK(options.num_design == 64);
  CHECK(options.max_simulations == 800);
  CHECK(options.num_starts == FitOptions{}.num_starts);
}

TEST_CASE("Simulate: it writes result, curves and figures, of nominal and of fitted values",
          "[cli][simulate]") {
  const TempFolder folder("simulate");
  const ProgramRun r =
      run({"simulate", "--experiment", "unconfined_compression", "--soil", "loamy_sand", "--quick",
           "--set", "friction=0.3", "--seeds", "2", "--seed", "5", "--out", folder / "run"});
  CHECK(r.exit_code == exit_done);
  const Json result = read(folder.path() / "run" / "result.json");
  CHECK(result["schema"] == "tilth.simulation/1");
  CHECK(result["material"]["friction"] == 0.3);
  REQUIRE(result["runs"].size() == 2);
  CHECK(result["runs"][1]["packing_seed"] == 6);
  CHECK(result["runs"][0]["status"] == "completed");
  CHECK(result["runs"][0]["features"]["peak_stress_Pa"] > 0.0);
  CHECK(fs::exists(folder.path() / "run" / "curves" /
                   "unconfined_compression_seed6_stress_strain.csv"));
  const bool figure = fs::exists(folder.path() / "run" / "figures" /
                                 "unconfined_compression_stress_strain.svg");
  CHECK((figure || r.says({"no figure: "})));  // gnuplot may be absent, but then it is said
}

TEST_CASE("Simulate: a test that does not end is recorded, exit code 5", "[cli][simulate]") {
  const TempFolder folder("not_settled");
  // 20 kPa of modulus cannot carry 100 kPa before 40 % strain.
  const ProgramRun r =
      run({"simulate", "--experiment", "confined_compression", "--soil", "loamy_sand", "--quick",
           "--set", "contact_modulus_Pa=2e4", "--set", "bond_modulus_Pa=2e4", "--set",
           "max_axial_strain=0.1", "--out", folder / "run"});
  CHECK(r.exit_code == exit_failed_runs);
  const Json run = read(folder.path() / "run" / "result.json")["runs"][0];
  CHECK(run["status"] == "not_settled");
  CHECK(run["message"].get<std::string>().find("reached strain 0.1") != std::string::npos);
}
