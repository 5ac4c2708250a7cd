// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate simulate --experiment sweep_tillage`: files to look at, and what is refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/fit_job.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/vtk_files.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::cli_test;
using Catch::Matchers::Contains;

namespace {

std::vector<std::string> sweep_command(const std::string& out, std::vector<std::string> more) {
  std::vector<std::string> all = {"simulate",    "--experiment", "sweep_tillage", "--soil",
                                  "coarse_sand", "--quick",      "--out",         out};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

}  // namespace

TEST_CASE("Tracers: the sites of a plot are one pass of the tool, and carry their features", "[cli][sweep]") {
  soil_test::SoilFolder folder("loamy_sand", "tracer_plan");
  folder.append("conditions.csv", "bin_A,,,,,,,,0.08,,shallow");
  soil_test::write_text(folder.path() / "tracers.csv",
                        "plotId,tracerId,initial_depth_m,initial_lateral_m,forward_m,lateral_m,vertical_m,"
                        "sigma_m,holdout,provenance,source\n"
                        "bin_A,1,0.06,-0.1,0.12,0,0,0.02,0,synthetic,made up\n"
                        "bin_A,2,0.03,0.05,0.16,0,0,0.02,0,synthetic,made up\n");
  const SoilData soil = load_soil(folder.path());
  std::vector<PlannedTest> sweeps;
  for (const PlannedTest& t : plan_tests(soil, Fidelity::preview))
    if (std::string(test_id(t.config)) == "sweep_tillage") sweeps.push_back(t);
  REQUIRE(sweeps.size() == 1);
  const auto& config = std::get<SweepTillageConfig>(sweeps.front().config);
  CHECK(config.tracer_depth_m == std::vector<double>{0.03, 0.06});
  CHECK(config.tracer_lateral_m == std::vector<double>{-0.1, 0.05});
  CHECK(config.tool_depth_m == 0.08);
  CHECK(soil_tables(folder.path()).back().filename() == "tracers.csv");  // an input of the fit
  CHECK(config.bulk_density_kg_per_m3 == 1450 * (1 + 0.1915));
  REQUIRE(sweeps.front().answers.size() == 6);
  CHECK(sweeps.front().answers[0].feature == "forward_displacement_m@0.03m_0.05m");

  // A preview leaves them out and says so, unless they are asked for.
  const auto num_of_sweep = [&](bool quick, const std::string& tests) {
    JobOptions o;
    o.soil_folder = folder.path().string();
    o.quick = quick;
    o.tests = tests;
    const FitJob job = read_job(o);
    const bool says_so = std::ranges::any_of(job.soil.warnings, [](const std::string& w) {
      return w.find("leaves out the 6 targets of the sweep") != std::string::npos;
    });
    CHECK(says_so == (quick && tests.empty()));
    // The tracers are synthetic, the mechanical targets are not: a fit of both says how many.
    const bool warns = std::ranges::any_of(job.soil.warnings, [](const std::string& w) {
      return w.starts_with("6 of 10 targets of the fit are synthetic");
    });
    CHECK(warns == (tests == "all" || (!quick && tests.empty())));
    return std::ranges::count(job.soil.targets, "sweep_tillage", &SoilTarget::test_id);
  };
  CHECK(num_of_sweep(false, "") == 6);
  CHECK(num_of_sweep(true, "") == 0);
  CHECK(num_of_sweep(true, "all") == 6);
  CHECK(num_of_sweep(true, "sweep") == 6);
  CHECK(num_of_sweep(false, "mechanical") == 0);
  CHECK(sweeps.front().answers[5].feature == "vertical_displacement_m@0.06m_-0.1m");
}

TEST_CASE("Program: a sweep on two threads gives the bytes of one", "[cli][sweep][threads]") {
  const TempFolder folder("sweep_threads");
  std::vector<std::string> results;
  for (const char* threads : {"1", "2"}) {
    const std::string out = folder / threads;
    REQUIRE(run(sweep_command(out, {"--threads", threads})).exit_code == exit_done);
    std::string text = text_of(std::filesystem::path(out) / "result.json");
    // the command line is the only difference
    for (const std::string& said : {out, std::string("--threads ") + threads})
      for (std::size_t at = text.find(said); at != std::string::npos; at = text.find(said)) text.erase(at, said.size());
    results.push_back(text);
  }
  CHECK(results[0] == results[1]);
}

TEST_CASE("Program: a sweep leaves curves, pictures and a ParaView series", "[cli][sweep]") {
  const TempFolder folder("sweep");
  const ProgramRun r = run(sweep_command(
      folder / "run",
      {"--vtk", "--set", "bin_width_m=0.3", "bin_length_m=0.62", "bed_depth_m=0.09",
       "particle_radius_m=0.018", "tool_depth_m=0.05", "speed_m_per_s=2", "tool_width_m=0.12",
       "wing_height_m=0.02", "tool_thickness_m=0.004", "shank_width_m=0.015", "shank_length_m=0.03",
       "end_clearance_m=0.08", "tracer_depth_m=0.02,0.04", "tracer_lateral_m=0",
       "contact_modulus_Pa=5e5", "bond_modulus_Pa=5e5"}));
  INFO(r.errors);
  REQUIRE(r.exit_code == exit_done);
  CHECK_THAT(r.output, Contains("draught_N") && Contains("forward_displacement_m@0.02m_0m"));
  const std::filesystem::path run_folder(folder / "run");
  // moist: 1472 (1 + 0.1143), the soil's own state
  CHECK_THAT(text_of(run_folder / "result.json"), Contains("\"bulk_density_kg_per_m3\": 1640.2"));
  for (const char* curve :
       {"sweep_forces", "tracers", "tracer_means", "surface_before", "surface_after", "furrow"})
    CHECK(std::filesystem::exists(run_folder / "curves" /
                                  ("sweep_tillage_seed1_" + std::string(curve) + ".csv")));
  const std::filesystem::path vtk = run_folder / "vtk" / "seed1";
  for (const char* what : {"particles", "tool", "tracers"}) {
    const std::string series = text_of(vtk / (std::string(what) + ".pvd"));
    // 0.54 m of travel, a step every 0.05 m, and settled, stopped, at rest
    CHECK(times(series, "<DataSet ") == 11 + 3);
    CHECK(std::filesystem::exists(vtk / (std::string(what) + "_0013.vtp")));
  }
  const std::string particles = text_of(vtk / "particles_0013.vtp");
  for (const char* array : {"radius_m", "displacement_m", "bonds_left"})
    CHECK_THAT(particles, Contains("Name=\"" + std::string(array) + "\""));
}

TEST_CASE("Program: a sweep that cannot be is refused before a folder is made",
          "[cli][sweep][bad_input]") {
  const TempFolder folder("sweep_bad");
  const auto refused = [&folder](std::vector<std::string> more, const std::string& part) {
    const ProgramRun r = run(sweep_command(folder / "run", std::move(more)));
    INFO(r.errors);
    CHECK(r.exit_code == exit_bad_input);
    CHECK(r.says({part}));
    CHECK_FALSE(std::filesystem::exists(folder / "run"));
  };
  refused({"--set", "particle_radius_m=0.06"}, "the limit is");
  refused({"--set", "bulk_density_kg_per_m3=2650"}, "bulk_density_kg_per_m3 = 2650");
  refused({"--set", "tracer_lateral_m=0,0.5"}, "outside the bin");
  refused({"--set", "tool_width_m=0.9"}, "the tool reaches");
  refused({"--tool", folder / "none.stl"}, "cannot read");
  refused({"--tool", folder.write("cut.stl", "solid x\nfacet\nvertex 1 2 3\n")}, "ends early");
  const ProgramRun other = run({"simulate", "--experiment", "direct_shear", "--soil", "loamy_sand",
                                "--quick", "--vtk", "--out", folder / "run"});
  CHECK(other.exit_code == exit_bad_input);
  CHECK(other.says({"need --experiment sweep_tillage"}));
}

TEST_CASE("vtk: points and triangles stand in the file as they are", "[cli][sweep]") {
  const std::string points = vtp_points({{1, 2, 3}, {4, 5, 6}}, {{"radius_m", {0.5, 0.25}}}, {});
  CHECK_THAT(points, Contains("NumberOfPoints=\"2\" NumberOfVerts=\"2\"") && Contains("4 5 6\n") &&
                         Contains("Name=\"radius_m\" format=\"ascii\">\n0.5\n0.25\n"));
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  CHECK_THAT(vtp_mesh(mesh), Contains("NumberOfPolys=\"4\"") &&
                                 Contains("0 2 1 0 1 3 0 3 2 1 2 3") && Contains("3 6 9 12"));
  CHECK_THAT(pvd_series({{0.5, "a.vtp"}}), Contains("timestep=\"0.5\" part=\"0\" file=\"a.vtp\""));
}
