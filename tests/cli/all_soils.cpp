// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate --soil all`: fits one after the other and the comparison of soils.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/soil_comparison.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// $TILTH_DATA for the life of the object.
class DataRoot {
 public:
  explicit DataRoot(const fs::path& root) { ::setenv("TILTH_DATA", root.c_str(), 1); }
  ~DataRoot() { ::unsetenv("TILTH_DATA"); }
  DataRoot(const DataRoot&) = delete;
  DataRoot& operator=(const DataRoot&) = delete;
};

constexpr const char* no_tracers =
    "plotId,tracerId,initial_depth_m,initial_lateral_m,forward_m,lateral_m,vertical_m,sigma_m,holdout,provenance,source\n";

/// Two soils of one cheap test each; the second wants twice the strength.
void make_data_root(const TempFolder& folder) {
  const fs::path soil = one_test_soil(folder);
  for (const char* id : {"strong", "weak"}) {
    const fs::path own = folder.path() / "soils" / id;
    fs::create_directories(own.parent_path());
    fs::copy(soil, own);
    std::string json = soil_test::read_text(own / "soil.json");
    json.replace(json.find("\"loamy_sand\""), 12, "\"" + std::string(id) + "\"");
    soil_test::write_text(own / "soil.json", json);
    soil_test::write_text(own / "tracers.csv", no_tracers);
  }
  std::string strong = soil_test::read_text(folder.path() / "soils" / "strong" / "measurements.csv");
  strong.replace(strong.find("14160"), 5, "56640");
  soil_test::write_text(folder.path() / "soils" / "strong" / "measurements.csv", strong);
}

FittedSet::Value value(double low, double high) { return {"friction", 0.5 * (low + high), low, high, "calibrated", ""}; }

}  // namespace

TEST_CASE("All soils: intervals that overlap are not distinguishable", "[cli][all_soils]") {
  CHECK(difference_word(value(1, 2), value(1.5, 3)) == std::string("not distinguishable"));
  CHECK(difference_word(value(1, 2), value(2.5, 3)) == std::string("differ"));
  CHECK(difference_word(value(2.5, 3), value(1, 2)) == std::string("differ"));
  CHECK(difference_word(value(1, 2), value(2.5, std::numeric_limits<double>::quiet_NaN())) ==
        std::string("not known"));
}

TEST_CASE("All soils: every soil's mistakes are listed",
          "[cli][all_soils][bad_input]") {
  const TempFolder folder("all_soils_bad");
  make_data_root(folder);
  const DataRoot root(folder.path());
  soil_test::write_text(folder.path() / "soils" / "weak" / "tracers.csv", "plotId\n");
  fs::remove(folder.path() / "soils" / "strong" / "parameters.csv");
  const ProgramRun r = run({"--soil", "all", "--out", folder / "run"});
  INFO(r.errors);
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({"weak: ", "strong: ", "parameters.csv"}));
  CHECK_FALSE(fs::exists(folder / "run"));
}

TEST_CASE("All soils: those fitted with other parameters than most are left out by name", "[cli][all_soils]") {
  const TempFolder folder("all_soils_kinds");
  make_data_root(folder);
  const DataRoot root(folder.path());
  fs::copy(folder.path() / "soils" / "weak", folder.path() / "soils" / "odd");
  std::string json = soil_test::read_text(folder.path() / "soils" / "odd" / "soil.json");
  json.replace(json.find("\"weak\""), 6, "\"odd\"");
  soil_test::write_text(folder.path() / "soils" / "odd" / "soil.json", json);
  const fs::path parameters = folder.path() / "soils" / "odd" / "parameters.csv";
  std::string table = soil_test::read_text(parameters);
  const std::string free = "friction,lin,0.05,1.5,0.5,1,none,,,contact,,calibrated";
  REQUIRE(table.find(free) != std::string::npos);
  table.replace(table.find(free), free.size(), "friction,lin,,,0.5,0,none,,,contact,,fixed");
  soil_test::write_text(parameters, table);
  INFO(run({"check", (folder.path() / "soils" / "odd").string()}).errors);
  const SoilsOfOneKind kind = soils_of_one_kind();
  CHECK(kind.soils == std::vector<std::string>{"strong", "weak"});
  REQUIRE(kind.left_out.size() == 1);
  CHECK(kind.left_out[0].find("odd: left out of --soil all") == 0);
  // nothing to fit in the sweep: refused, but not before it is said who is meant
  const ProgramRun r = run({"--soil", "all", "--tests", "sweep", "--out", folder / "run"});
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({kind.left_out[0], "weak: ", "strong: "}));
}

TEST_CASE("All soils: two fits in folders of their own, and what differs", "[cli][all_soils]") {
  const TempFolder folder("all_soils");
  make_data_root(folder);
  const DataRoot root(folder.path());
  const std::string config = folder.write("tiny.json", tiny_config());
  const ProgramRun r = run({"--soil", "all", "--tests", "mechanical", "--quick", "--config", config, "--out", folder / "run"});
  INFO(r.errors);
  REQUIRE((r.exit_code == exit_done || r.exit_code == exit_holdout_failed || r.exit_code == exit_unreachable));
  const fs::path out(folder / "run");
  for (const char* id : {"strong", "weak"}) CHECK(fs::exists(out / id / "report.html"));
  CHECK(fs::exists(out / "figures" / "comparison.svg"));
  CHECK_THAT(soil_test::read_text(out / "comparison.txt"),
             Contains("PREVIEW") && Contains("forward_displacement_m@0.05m") && Contains("ASABE D497"));
  const auto card = nlohmann::json::parse(soil_test::read_text(out / "comparison.json"));
  REQUIRE(card["soils"].size() == 2);
  double strength_Pa[2] = {};
  for (std::size_t k = 0; k < 2; ++k)
    for (const auto& p : card["soils"][k]["parameters"])
      if (p["name"] == "bond_tensile_strength_Pa") strength_Pa[k] = p["value"];
  CHECK(card["soils"][0]["soil"] == "strong");
  CHECK(strength_Pa[0] > 2 * strength_Pa[1]);
  CHECK(card["soils"][0]["sweep"]["draught_N"]["mean"].get<double>() > 0);
}
