// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate sensitivity` as a user runs it, on the smallest problem there is.
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "calibrate/cli/exit_code.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using soil_test::read_text;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

Json read(const fs::path& folder) { return Json::parse(read_text(folder / "sensitivity.json")); }

std::string comparable(const fs::path& folder) {
  Json card = read(folder);
  card.erase("timing");
  card.erase("reproduction");
  return card.dump();
}

/// A preview of one_test_soil() with friction held: two parameters, three features, one test.
std::vector<std::string> tiny_study(const TempFolder& folder, const std::string& soil,
                                    const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {
      "sensitivity", "--data", soil, "--config", folder.write("fit.json", tiny_config()), "--quick",
      "--packings", "2"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::size_t num_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("Sensitivity command: all mistakes are listed at once, and nothing is written",
          "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_mistakes");
  const ProgramRun r =
      run({"sensitivity", "--soil", "loamy_sandy", "--method", "moris", "--samples", "1",
           "--levels", "3", "--packings", "0", "--out", folder / "run"});
  INFO(r.errors);
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({"5 problems", "did you mean loamy_sand?", "did you mean morris?",
                "samples = 1: must be 4 or more", "levels = 3", "packings = 0"}));
  CHECK_FALSE(fs::exists(folder / "run"));

  const std::string held = folder.write("held.json", R"({"schema": "tilth.fit/1", "parameters": [
      {"name": "bond_modulus_Pa", "value": 1e6}, {"name": "friction", "value": 0.5},
      {"name": "bond_tensile_strength_Pa", "value": 3000}]})");
  const ProgramRun none = run({"sensitivity", "--soil", "loamy_sand", "--method", "sobol",
                               "--config", held, "--out", folder / "run"});
  CHECK(none.exit_code == exit_bad_input);
  CHECK(none.says({"no parameter is free"}));
  CHECK(run({"sensitivity", "--soil", "loamy_sand"}).says({"--method is missing"}));
  CHECK(run({"sensitivity", "--soil", "loamy_sand", "--method", "morris", "--emulator"})
            .says({"--emulator: goes with --method sobol only"}));
  CHECK(run({"sensitivity", "--soil", "loamy_sand", "--extend"}).says({"--out is missing"}));
  CHECK_FALSE(fs::exists(folder / "run"));
}

TEST_CASE("Sensitivity command: Morris writes tables and figures, the same on any threads",
          "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_morris");
  const std::string soil = one_test_soil(folder);
  const auto morris = [&](const std::string& threads) {
    const ProgramRun r = run(tiny_study(folder, soil, {"--method", "morris", "--samples", "4",
                                                       "--threads", threads, "--out",
                                                       folder / ("t" + threads)}));
    INFO(r.errors);
    CHECK(r.exit_code == exit_done);
    CHECK(r.output.find("PREVIEW") != std::string::npos);
    CHECK(r.output.find("4 levels") != std::string::npos);
    CHECK((fs::exists(folder.path() / ("t" + threads) / "figures") || r.says({"no figure: "})));
    return folder.path() / ("t" + threads);
  };
  const fs::path one = morris("1");
  CHECK(comparable(morris("2")) == comparable(one));
  const Json card = read(one);
  for (const char* key : {"schema", "tool", "inputs", "seed", "status", "message", "provenance",
                          "study", "features", "cost", "failed_runs", "timing", "reproduction"})
    CHECK(card.contains(key));
  CHECK(card["preview"] == true);
  CHECK(card["study"]["levels"] == 4);
  REQUIRE(card["features"].size() == 3);
  CHECK(card["features"][0]["scale"] == "ln(value)");
  CHECK(card["features"][0]["indices"].size() == 6);
  CHECK(card["features"][0]["failures"].contains("share"));
  // A peak rises with the bond strength.
  CHECK(card["features"][0]["indices"][1]["parameter"] == "bond_tensile_strength_Pa");
  CHECK(card["features"][0]["indices"][1]["value"] > 1.0);
  CHECK(num_lines(read_text(one / "sensitivity.csv")) == 1 + 3 * 6);
  CHECK(read_text(one / "sensitivity.txt").find("PREVIEW") != std::string::npos);
}

TEST_CASE("Sensitivity command: --extend doubles the samples and keeps the old runs",
          "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_extend");
  const std::string soil = one_test_soil(folder);
  const std::string out = folder / "run";
  CHECK(run(tiny_study(folder, soil, {"--method", "morris", "--samples", "4", "--out", out}))
            .exit_code == exit_done);
  const std::string before = read_text(folder.path() / "run" / "samples.csv");
  const ProgramRun refused =
      run(tiny_study(folder, soil, {"--extend", "--samples", "3", "--seed", "9", "--out", out}));
  CHECK(refused.exit_code == exit_bad_input);
  CHECK(refused.says({"--samples 3: the study in --out has 4", "--seed 9", "it cannot change"}));
  const ProgramRun other_soil = run({"sensitivity", "--soil", "sandy_loam", "--extend", "--out", out});
  CHECK(other_soil.exit_code == exit_bad_input);
  CHECK(other_soil.says({"are not those of the study in --out"}));

  const ProgramRun r = run(tiny_study(folder, soil, {"--extend", "--out", out}));
  INFO(r.errors);
  CHECK(r.exit_code == exit_done);
  const std::string after = read_text(folder.path() / "run" / "samples.csv");
  CHECK(read(folder.path() / "run")["study"]["samples_finished"] == 8);
  CHECK(after.starts_with(before));
  CHECK(after.size() > before.size());
}

TEST_CASE("Sensitivity command: Sobol from an emulator says that it is one", "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_emulator");
  const std::string soil = one_test_soil(folder);
  const ProgramRun r = run(tiny_study(
      folder, soil, {"--method", "sobol", "--emulator", "--samples", "8", "--out", folder / "run"}));
  INFO(r.errors);
  CHECK(r.exit_code == exit_done);
  CHECK(r.output.find("EMULATOR") != std::string::npos);
  const Json card = read(folder.path() / "run");
  CHECK(card["study"]["method"] == "sobol by emulator");
  CHECK(card["features"][0]["emulator"].contains("leave_one_out_q2"));
  CHECK(card["features"][0]["indices"].size() == 5);  // S and ST of two, one pair
}

TEST_CASE("Sensitivity command: Ctrl-C leaves the result of the finished rows, exit code 3",
          "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_interrupt");
  const std::string soil = one_test_soil(folder);
  const ProgramRun r = run_and_signal(
      tiny_study(folder, soil, {"--method", "sobol", "--samples", "4096", "--threads", "1", "--out",
                                "run"}),
      folder.path(), "simulations", SIGINT);
  INFO(r.errors);
  CHECK(r.exit_code == exit_budget);
  const Json card = read(folder.path() / "run");
  CHECK(card["status"] == "stopped");
  CHECK(card["study"]["samples_finished"] > 0);
  CHECK(card["study"]["samples_finished"] < 4096);
  CHECK(card["features"][0]["indices"].size() == 5);
}
