// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Every mistake is named, ends with exit code 2, and leaves nothing behind.
#include <catch2/catch.hpp>

#include "calibrate/cli/exit_code.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using soil_test::SoilFolder;

namespace {

/// A fit of a shipped soil with this config, refused; the run folder must not appear.
ProgramRun refused_config(const TempFolder& folder, const std::string& text) {
  const ProgramRun r = run({"--soil", "loamy_sand", "--quick", "--out", folder / "run", "--config",
                            folder.write("fit.json", text)});
  CHECK(r.exit_code == exit_bad_input);
  CHECK_FALSE(std::filesystem::exists(folder / "run"));
  return r;
}

ProgramRun refused_simulation(const TempFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "simulate");
  arguments.insert(arguments.end(), {"--quick", "--out", folder / "run"});
  const ProgramRun r = run(arguments);
  CHECK(r.exit_code == exit_bad_input);
  CHECK_FALSE(std::filesystem::exists(folder / "run"));
  return r;
}

std::string with_parameter(const std::string& entry) {
  return R"({"schema": "tilth.fit/1", "parameters": [)" + entry + "]}";
}

}  // namespace

TEST_CASE("Program: wrong flags end with exit code 2 and say which", "[cli][bad_input]") {
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& part) {
    const ProgramRun r = run(arguments);
    INFO(r.errors);
    CHECK(r.exit_code == exit_bad_input);
    CHECK(r.says({part}));
  };
  refused({}, "--soil is missing: one of coarse_sand, karlsruhe_fine_sand, loamy_sand, sandy_loam");
  refused({"--sool", "x"}, "--sool");
  refused({"--soil", "loamy_sand", "--threads", "many"}, "--threads");
  refused({"--soil", "loamy_sand", "--lanes", "3"}, "--lanes");
  // Accepted by the first version, as 2^64 - 1. The folder keeps a wrong program from fitting.
  refused({"--soil", "loamy_sand", "--seed", "-1", "--out", "/proc/tilth"}, "--seed");
  refused({"--soil", "loamy_sand", "--data", "x"}, "--data");
  refused({"simulate", "--soil", "loamy_sand"}, "--experiment is required");
  refused({"simulate", "--experiment", "direct_shear", "--seeds", "0"}, "--seeds");
  refused({"check"}, "target is required");
  refused({"chek"}, "chek");
}

TEST_CASE("Program: help and version end with exit code 0", "[cli]") {
  CHECK(run({"--help"}).exit_code == exit_done);
  CHECK(run({"--help"}).output.find("--soil") != std::string::npos);
  CHECK(run({"simulate", "--help"}).output.find("--experiment") != std::string::npos);
  CHECK(run({"--version"}).output.find("tilth ") == 0);
}

TEST_CASE("Program: an unknown soil lists the known ones and the nearest", "[cli][bad_input]") {
  const TempFolder folder("unknown_soil");
  const ProgramRun r = run({"--soil", "loamysand", "--out", folder / "run"});
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({"unknown soil 'loamysand'", "coarse_sand, karlsruhe_fine_sand, loamy_sand, sandy_loam",
                "did you mean loamy_sand?"}));
  CHECK_FALSE(std::filesystem::exists(folder / "run"));
  CHECK(run({"--data", folder / "nowhere"}).says({"--data", "nowhere: is not a folder"}));
}

TEST_CASE("Program: a missing or malformed config is named with file and line",
          "[cli][bad_input]") {
  const TempFolder folder("config_text");
  const ProgramRun missing = run({"--soil", "loamy_sand", "--config", folder / "none.json"});
  CHECK(missing.exit_code == exit_bad_input);
  CHECK(missing.says({"none.json: the file is missing"}));
  CHECK(refused_config(folder, "{\n \"schema\": \"tilth.fit/1\",\n \"fit\": {,}\n}\n")
            .says({"fit.json:3: malformed JSON"}));
  CHECK(refused_config(folder, with_parameter(R"({"name": "friction", "value": NaN})"))
            .says({"fit.json:1: malformed JSON"}));
  CHECK(refused_config(folder, R"({"schema": "tilth.fit/9"})").says({"/schema", "tilth.fit/1"}));
}

TEST_CASE("Program: all problems of a config are listed at once, with the nearest name",
          "[cli][bad_input]") {
  const TempFolder folder("config_keys");
  const ProgramRun keys = refused_config(
      folder, R"({"schema": "tilth.fit/1", "paramters": [],
                  "fit": {"num_desgin": 3, "num_starts": 0, "holdout_limit": -1}})");
  CHECK(keys.says({"4 problems:", "unknown key 'paramters'", "did you mean parameters?",
                   "unknown key 'num_desgin'", "did you mean num_design?",
                   "/fit/num_starts = 0: must be an integer in [1, 1000000]",
                   "/fit/holdout_limit = -1: must be a number > 0"}));
  const ProgramRun names = refused_config(
      folder, R"({"schema": "tilth.fit/1", "holdout": ["direct_shear/cohesoin_Pa"], "parameters": [
                  {"name": "friction", "lower": 0.9, "upper": 0.1},
                  {"name": "frction", "value": 1},
                  {"name": "contact_modulus_Pa", "value": -2e6}]})");
  CHECK(names.says({"friction: lower = 0.9 must be below upper = 0.1",
                    "unknown parameter 'frction'", "did you mean friction?",
                    "contact_modulus_Pa: nominal = -2000000 is not possible",
                    "unknown target 'direct_shear/cohesoin_Pa'"}));
}

TEST_CASE("Program: a fit that the data cannot carry is refused before a folder is made",
          "[cli][bad_input]") {
  const TempFolder folder("under_determined");
  const ProgramRun r = refused_config(
      folder, with_parameter(R"({"name": "bond_cohesion_Pa", "tied_to": "", "estimate": true,
                                 "lower": 300, "upper": 1e5},
                                {"name": "stiffness_ratio", "estimate": true,
                                 "lower": 1, "upper": 4})"));
  // The first version of the program left a folder with config.json and log.txt.
  CHECK(r.says({"5 free parameters (bond_modulus_Pa", "stiffness_ratio",
                "only 4 independent observations"}));
}

TEST_CASE("Program: a broken data folder is named with file and line, by check and by fit",
          "[cli][bad_input]") {
  const TempFolder out("broken_folder");
  SoilFolder soil("loamy_sand", "cli_broken_folder");
  soil.replace("measurements.csv", "0.57596,0.05236", "abc,0.05236");
  soil.replace("parameters.csv", "friction,lin,0.05,1.5", "friction,lin,1.5,0.05");
  soil.replace("parameters.csv", "contact_modulus_Pa,log10,,,3e6,0,none,,,contact,1.0*bond_modulus_Pa",
               "contact_modulus_Pa,lin,,,-3e6,0,none,,,contact,");
  for (const ProgramRun& r : {run({"check", soil.path().string()}),
                              run({"--data", soil.path().string(), "--out", out / "run"})}) {
    INFO(r.errors);
    CHECK(r.exit_code == exit_bad_input);
    CHECK(r.says({"measurements.csv:3: value = 'abc' is not a finite number",
                  "parameters.csv:4: friction: lower = 1.5 must be below upper = 0.05",
                  "parameters.csv:5: contact_modulus_Pa: nominal = -3000000 is not possible"}));
    CHECK_FALSE(std::filesystem::exists(out / "run"));
  }
  soil.replace("parameters.csv", "parameterId", "parameter_id");
  CHECK(run({"check", soil.path().string()}).says({"parameters.csv:1:", "parameterId"}));
  std::filesystem::remove(soil.path() / "conditions.csv");
  CHECK(run({"check", soil.path().string()}).says({"conditions.csv"}));
}

TEST_CASE("Program: check passes what is right", "[cli]") {
  const TempFolder folder("check");
  for (const char* soil : {"coarse_sand", "loamy_sand", "sandy_loam"}) {
    const ProgramRun r = run({"check", std::string(TILTH_SOURCE_DIR) + "/data/soils/" + soil});
    CHECK(r.exit_code == exit_done);
    CHECK(r.output.find("no problems; measured targets: 0 of") != std::string::npos);
    CHECK(r.errors.empty());
  }
  const ProgramRun config = run({"check", folder.write("fit.json", tiny_config())});
  CHECK(config.exit_code == exit_done);
  CHECK(config.output.find("fit.json: no problems") != std::string::npos);
}

TEST_CASE("Program: check finds mistakes inside a config's fit object", "[cli][bad_input]") {
  const TempFolder folder("check_config");
  // The first version of check did not look inside "fit".
  const ProgramRun r = run({"check", folder.write("fit.json", tiny_config(R"(, "num_strats": 2)"))});
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({"unknown key 'num_strats'", "did you mean num_starts?"}));
  const ProgramRun nothing = run({"check", folder / "nowhere"});
  CHECK(nothing.exit_code == exit_bad_input);
  CHECK(nothing.says({"there is no such folder or file"}));
}

TEST_CASE("Program: an unwritable --out is refused before anything is computed",
          "[cli][bad_input]") {
  const TempFolder folder("unwritable");
  const std::string file = folder.write("file", "x");
  for (const std::string& out : {file + "/run", file, std::string("/proc/tilth")}) {
    const ProgramRun fit = run({"--soil", "loamy_sand", "--quick", "--out", out});
    CHECK(fit.exit_code == exit_bad_input);
    CHECK(fit.says({"--out " + out}));
    const ProgramRun simulation = run({"simulate", "--experiment", "unconfined_compression",
                                       "--soil", "loamy_sand", "--quick", "--out", out});
    CHECK(simulation.exit_code == exit_bad_input);
  }
  CHECK(soil_test::read_text(file) == "x");
}

TEST_CASE("Simulate: mistakes are listed once each", "[cli][bad_input]") {
  const TempFolder folder("simulate_mistakes");
  const ProgramRun experiment =
      refused_simulation(folder, {"--experiment", "direct_sheer", "--soil", "loamy_sand"});
  CHECK(experiment.says({"unknown experiment 'direct_sheer'",
                         "unconfined_compression, direct_shear, confined_compression",
                         "did you mean direct_shear?"}));
  // A far-fetched hint is worse than none; the first version said "did you mean ?".
  CHECK_FALSE(refused_simulation(folder, {"--experiment", "xyz", "--soil", "loamy_sand"})
                  .says({"did you mean"}));
  const ProgramRun settings = refused_simulation(
      folder, {"--experiment", "direct_shear", "--soil", "loamy_sand", "--set", "frictoin=0.3",
               "--set", "contact_modulus_Pa=-1", "--set", "friction=nan", "--set", "porosity",
               "--set", "num_particles=abc"});
  INFO(settings.errors);
  // Five, not seven: the first version repeated the numbers out of range.
  CHECK(settings.says({"5 problems:", "'frictoin'", "did you mean friction?",
                       "contact_modulus_Pa = -1: must be in [100,", "friction = nan: must be in",
                       "--set porosity: must be key=value", "num_particles = 'abc'"}));
  CHECK(refused_simulation(folder, {"--experiment", "direct_shear", "--fit", folder / "no_card"})
            .says({"no_card"}));
  CHECK(refused_simulation(folder, {"--experiment", "direct_shear"}).says({"--soil is missing"}));
}
