// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate scale`: series, similarity groups, what is refused, and a study in small.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/scale_groups.hpp"
#include "calibrate/cli/scale_report.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;
using soil_test::read_text;
namespace fs = std::filesystem;

namespace {

/// A bin of some 60 to 130 aggregates and a short, fast pass.
std::vector<std::string> tiny_study(const std::string& out, std::vector<std::string> more) {
  std::vector<std::string> all = {
      "scale",          "--soil",        "coarse_sand",          "--radii",  "19,16",
      "--packings",     "2",             "--out",                out,        "--set",
      "bin_width_m=0.3", "bin_length_m=0.62", "bed_depth_m=0.09", "tool_depth_m=0.05", "speed_m_per_s=2",
      "tool_width_m=0.12", "wing_height_m=0.02", "tool_thickness_m=0.004", "shank_width_m=0.015",
      "shank_length_m=0.03", "end_clearance_m=0.08", "tracer_depth_m=0.02,0.04",
      "tracer_lateral_m=-0.03,0,0.03", "contact_modulus_Pa=5e5", "bond_modulus_Pa=5e5"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// A series whose limit is known: a share of 25 per metre, no scatter but a trace of it.
ScaleResult made_up(const std::string& name, double tool_width_m, double slope_per_m) {
  ScaleResult r;
  r.series.name = name;
  r.series.config.sweep.width_m = tool_width_m;
  std::vector<SizeAnswers> answers;
  for (const double radius_m : {0.010, 0.015, 0.020}) {
    SizeAnswers a{radius_m, {}};
    const double u = 0.1 * (1 + slope_per_m * (radius_m - 0.010));
    for (const double noise : {-1e-5, 1e-5}) a.displacement_m.push_back(Eigen::VectorXd::Constant(1, u + noise));
    answers.push_back(a);
    r.sizes.push_back({radius_m, 100, {}, {}});
  }
  r.study = study_scale(answers, 0.15);
  r.density_at_limit = 100, r.density_lo95 = 90, r.density_hi95 = 110;
  return r;
}

}  // namespace

TEST_CASE("Scale: only the groups that hold a grain's length are lost", "[cli][scale]") {
  const SweepTillageConfig config;
  const SoilMaterial material;
  int num_lost = 0;
  for (const SimilarityGroup& g : similarity_groups(config, material, 0.010, 0.020)) {
    INFO(g.name);
    const bool has_radius = g.formula.find(" r ") != std::string::npos && g.formula.find("radii") == std::string::npos;
    CHECK(g.kept == !has_radius);
    if (has_radius) CHECK_THAT(g.coarsest, WithinRel(2 * g.finest, 1e-12));
    num_lost += has_radius;
  }
  CHECK(num_lost == 5);
}

TEST_CASE("Scale: the sentence gives limit, tool width over it, tolerance and interval", "[cli][scale]") {
  // 10 mm + 0.15 / 25 per m = 16 mm; 250 / 16 = 15.6
  CHECK_THAT(scale_sentence(made_up("a", 0.25, 25.0)),
             Contains("a: particles of up to 16 mm radius (tool width / 15.6) keep tracer displacement within 15 % of "
                      "that at 10 mm"));
  CHECK_THAT(scale_sentence(made_up("a", 0.25, 0.0)), Contains("all particles that were run, up to 20 mm radius"));
  ScaleResult failed = made_up("a", 0.25, 25.0);
  failed.no_study = "nothing completed";
  CHECK_THAT(scale_sentence(failed), Contains("a: no scale limit: nothing completed"));
}

TEST_CASE("Scale: what the limit follows is where the intervals overlap", "[cli][scale]") {
  // The same radius, other widths: the limit follows the radius.
  std::vector<ScaleResult> both = {made_up("wide", 0.25, 25.0), made_up("narrow", 0.15, 25.0)};
  std::vector<std::string> sentences = cause_sentences(both);
  REQUIRE(sentences.size() == 3);
  CHECK_THAT(sentences[0], Contains("radius") && Contains("compatible"));
  CHECK_THAT(sentences[1], Contains("width over radius") && Contains("differ"));
  CHECK_THAT(sentences[2], Contains("contacts") && Contains("compatible"));
  both[1].density_lo95 = 120, both[1].density_hi95 = 130;
  CHECK_THAT(cause_sentences(both)[2], Contains("differ"));
  both[1].study.limit.verdict = ScaleVerdict::undecided;
  CHECK_THAT(cause_sentences(both).front(), Contains("cannot be told"));
}

TEST_CASE("Scale command: all mistakes are listed at once, and nothing is written", "[cli][scale][bad_input]") {
  const TempFolder folder("scale_mistakes");
  const auto refused = [&folder](std::vector<std::string> more, const std::vector<std::string>& parts) {
    std::vector<std::string> all = {"scale", "--out", folder / "run"};
    all.insert(all.end(), more.begin(), more.end());
    const ProgramRun r = run(all);
    INFO(r.errors);
    CHECK(r.exit_code == exit_bad_input);
    CHECK(r.says(parts));
    CHECK_FALSE(fs::exists(folder / "run"));
  };
  refused({"--soil", "loamy_sand", "--radii", "10,10", "--set", "tool_widht_m=1", "--variant", "narrow"},
          {"3 problems", "two different sizes", "did you mean tool_width_m?", "--variant narrow: must be NAME:"});
  refused({"--soil", "loamy_sand", "--radii", "80,20"}, {"particle_radius_m = 0.08", "the limit is"});
  refused({"--soil", "loam"}, {"soil"});
  refused({"--soil", "loamy_sand", "--radii", "10,-3"}, {"--radii"});
  refused({"--soil", "loamy_sand", "--variant", "x:porosity=0.1"}, {"porosity = 0.1"});
}

TEST_CASE("Scale command: a study in small, and the same again from its store", "[cli][scale]") {
  const TempFolder folder("scale");
  const ProgramRun first = run(tiny_study(folder / "run", {"--variant", "loose:bond_gap_over_radius=-1"}));
  INFO(first.errors);
  REQUIRE(first.exit_code == exit_done);
  CHECK_THAT(first.output, Contains("[[coarse_sand loose]]") && Contains("work to fracture"));
  CHECK_THAT(first.output, Contains("8 tests simulated, 0 from the store"));
  const fs::path out(folder / "run");
  const auto card = nlohmann::json::parse(read_text(out / "scale.json"));
  CHECK(card["schema"] == "tilth.scale/1");
  REQUIRE(card["series"].size() == 2);
  for (const auto& series : card["series"]) {
    CHECK(series["num_tracer_sites"] == 4);  // 2 depths x (path, 30 mm aside)
    REQUIRE(series["sizes"].size() == 2);
    CHECK(series["sizes"][0]["radius_m"] == 0.016);
    CHECK(series["sizes"][0]["num_particles"].get<int>() > series["sizes"][1]["num_particles"].get<int>());
    CHECK(series["sizes"][1]["contact_density_per_m2"]["mean"].get<double>() > 0.0);
  }
  for (const char* file : {"scale.csv", "scale_report.txt", "figures/scale.svg", "timing.json", "config.json"})
    CHECK(fs::exists(out / file));
  const std::string before = read_text(out / "scale.json");
  const ProgramRun again =
      run(tiny_study(folder / "run", {"--variant", "loose:bond_gap_over_radius=-1", "--resume"}));
  CHECK_THAT(again.output, Contains("0 tests simulated, 8 from the store"));
  CHECK(read_text(out / "scale.json") == before);
}
