// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate sensitivity` as a user runs it, on the smallest problem there is.
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/sensitivity_study.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using soil_test::read_text;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

Json read(const fs::path& folder) { return Json::parse(read_text(folder / "sensitivity.json")); }

/// A preview of one_test_soil() on one packing with only the bond strength free: three features of
/// one test, and four different runs on a Morris grid.
std::vector<std::string> tiny_study(const TempFolder& folder, const std::string& soil,
                                    const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {
      "sensitivity",
      "--data",
      soil,
      "--quick",
      "--packings",
      "1",
      "--config",
      folder.write("held.json", R"({"schema": "tilth.fit/1", "parameters": [
          {"name": "bond_modulus_Pa", "value": 3e6}, {"name": "friction", "value": 0.5}]})")};
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
  CHECK(run({"sensitivity", "--soil", "loamy_sand", "--tests", "swep,bed"})
            .says({"2 problems", "--method is missing", "did you mean sweep?"}));
  CHECK_FALSE(fs::exists(folder / "run"));
}

TEST_CASE("Sensitivity command: Morris writes tables and figures, and --extend keeps the old runs",
          "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_morris");
  const std::string soil = one_test_soil(folder);
  const std::string out = folder / "run";
  const fs::path path = folder.path() / "run";
  const ProgramRun r = run(tiny_study(
      folder, soil, {"--method", "morris", "--samples", "4", "--threads", "1", "--out", out}));
  INFO(r.errors);
  CHECK(r.exit_code == exit_done);
  CHECK(r.output.find("PREVIEW") != std::string::npos);
  CHECK(r.output.find("4 levels") != std::string::npos);
  CHECK((fs::exists(path / "figures") || r.says({"no figure: "})));  // gnuplot may be absent
  const Json card = read(path);
  for (const char* key : {"schema", "tool", "inputs", "seed", "status", "message", "provenance",
                          "study", "features", "cost", "failed_runs", "reproduction"})
    CHECK(card.contains(key));
  CHECK(card["preview"] == true);
  CHECK(card["study"]["levels"] == 4);
  REQUIRE(card["features"].size() == 3);
  CHECK(card["features"][0]["scale"] == "ln(value)");
  REQUIRE(card["features"][0]["indices"].size() == 3);
  CHECK(card["features"][0]["failures"].contains("share"));
  // A peak rises with the bond strength.
  CHECK(card["features"][0]["indices"][0]["parameter"] == "bond_tensile_strength_Pa");
  CHECK(card["features"][0]["indices"][0]["value"] > 1.0);
  CHECK(num_lines(read_text(path / "sensitivity.csv")) == 1 + 3 * 3);
  CHECK(read_text(path / "sensitivity.txt").find("PREVIEW") != std::string::npos);

  const ProgramRun refused =
      run(tiny_study(folder, soil, {"--extend", "--samples", "3", "--seed", "9", "--out", out}));
  CHECK(refused.exit_code == exit_bad_input);
  CHECK(refused.says({"--samples 3: the study in --out has 4", "--seed 9", "it cannot change"}));
  const ProgramRun other_soil =
      run({"sensitivity", "--soil", "sandy_loam", "--extend", "--out", out});
  CHECK(other_soil.exit_code == exit_bad_input);
  CHECK(other_soil.says({"are not those of the study in --out"}));

  // The first runs keep every bit, on other threads too.
  const std::string before = read_text(path / "samples.csv");
  const ProgramRun more =
      run(tiny_study(folder, soil, {"--extend", "--samples", "5", "--threads", "2", "--out", out}));
  INFO(more.errors);
  CHECK(more.exit_code == exit_done);
  CHECK(read(path)["study"]["samples_finished"] == 5);
  // Four different runs are a whole grid of one parameter: nothing is left to simulate.
  const Json timing = Json::parse(read_text(path / "timing.json"));
  CHECK(timing["runs_simulated"] == 0);
  CHECK(timing["runs_from_store"] > 0);
  const std::string after = read_text(path / "samples.csv");
  CHECK(after.starts_with(before));
  CHECK(after.size() > before.size());
}

TEST_CASE("Sensitivity command: tests may be chosen that the soil's tables do not hold",
          "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_tests");
  const std::string soil = one_test_soil(folder);
  const std::string out = folder / "run";
  const ProgramRun r = run(tiny_study(folder, soil, {"--tests", "direct_tension", "--method", "morris",
                                                     "--samples", "4", "--threads", "1", "--out", out}));
  INFO(r.errors);
  CHECK(r.exit_code == exit_done);
  const Json card = read(folder.path() / "run");
  CHECK(card["study"]["tests"] == Json{"direct_tension"});
  REQUIRE(card["features"].size() == 2);
  CHECK(card["features"][0]["name"] == "direct_tension/tensile_strength_Pa/tension");
  CHECK(card["provenance"].get<std::string>().find("nothing measured is compared") == 0);
  const ProgramRun other = run(tiny_study(folder, soil, {"--extend", "--tests", "bed", "--out", out}));
  CHECK(other.exit_code == exit_bad_input);
  CHECK(other.says({"--tests: the study in --out is of other tests"}));
  const ProgramRun more = run(tiny_study(folder, soil, {"--extend", "--samples", "5", "--out", out}));
  CHECK(more.exit_code == exit_done);
  CHECK(read(folder.path() / "run")["study"]["tests"] == Json{"direct_tension"});
}

TEST_CASE("Sensitivity command: tracers are among the features, but not in a preview", "[cli][sensitivity]") {
  const auto study = [](bool quick, const std::vector<std::string>& tests) {
    SensitivityCommandOptions o;
    o.soil = "loamy_sand";
    o.method = "morris";
    o.quick = quick;
    o.tests = tests;
    return read_study(o);
  };
  const auto says_so = [](const SensitivityStudy& s) {
    return s.provenance.find("leaves out the 45 targets of the sweep") != std::string::npos;
  };
  const SensitivityStudy all = study(false, {}), preview = study(true, {});
  CHECK(all.targets.size() == 6 + 45);
  CHECK_FALSE(says_so(all));
  CHECK(preview.targets.size() == 6);
  CHECK(says_so(preview));
  CHECK(study(true, {"sweep"}).targets.size() == 4 + 6 * 3);
}

TEST_CASE("Sensitivity command: Sobol from an emulator says that it is one", "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_emulator");
  const std::string soil = one_test_soil(folder);
  const ProgramRun r = run(
      tiny_study(folder, soil,
                 {"--method", "sobol", "--emulator", "--samples", "5", "--out", folder / "run"}));
  INFO(r.errors);
  CHECK(r.exit_code == exit_done);
  CHECK(r.output.find("EMULATOR") != std::string::npos);
  const Json card = read(folder.path() / "run");
  CHECK(card["study"]["method"] == "sobol by emulator");
  CHECK(card["features"][0]["emulator"].contains("leave_one_out_q2"));
  CHECK(card["features"][0]["indices"].size() == 2);  // S and ST
}

TEST_CASE("Sensitivity command: Ctrl-C leaves the result of the finished rows, exit code 3",
          "[cli][sensitivity]") {
  const TempFolder folder("sensitivity_interrupt");
  const std::string soil = one_test_soil(folder);
  const ProgramRun r = run_and_signal(
      tiny_study(folder, soil,
                 {"--method", "sobol", "--samples", "4096", "--threads", "1", "--out", "run"}),
      folder.path(), "simulations", SIGINT);
  INFO(r.errors);
  CHECK(r.exit_code == exit_budget);
  const Json card = read(folder.path() / "run");
  CHECK(card["status"] == "stopped");
  CHECK(card["study"]["samples_finished"] > 0);
  CHECK(card["study"]["samples_finished"] < 4096);
  CHECK(card["features"][0]["indices"].size() == 2);
}
