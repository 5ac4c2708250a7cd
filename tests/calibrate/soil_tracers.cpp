// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// tracers.csv: sites become targets; what is wrong with a tracer is said with its line.
#include <catch2/catch.hpp>

#include "calibrate/soil_data.hpp"
#include "tests/calibrate/soil_folder.hpp"

using namespace tilth;
using tilth::soil_test::mentions;
using tilth::soil_test::SoilFolder;
using Catch::Matchers::WithinRel;

namespace {

const std::string header =
    "plotId,tracerId,initial_depth_m,initial_lateral_m,forward_m,lateral_m,vertical_m,sigma_m,holdout,"
    "provenance,source\n";
const std::string good =
    "bin_A,1,0.05,-0.1,0.12,-0.03,0.01,0.02,0,measured,field book\n"
    "bin_A,2,0.05,-0.1,0.16,-0.05,-0.01,0.02,0,synthetic,model\n"
    "bin_A,3,0.08,0,0.10,0,0.02,0.015,1,measured,field book\n";

/// The loamy sand with a plot and this tracers.csv.
struct TracerFolder {
  SoilFolder folder;
  TracerFolder(const std::string& name, const std::string& table) : folder("loamy_sand", "tracers_" + name) {
    folder.append("conditions.csv", "bin_A,0.191,1450,9806.65,,,,,0.1,0.889,one plot");
    soil_test::write_text(folder.path() / "tracers.csv", table);
  }
};

std::vector<std::string> spoilt(const std::string& name, const std::string& from, const std::string& to) {
  std::string table = header + good;
  table.replace(table.find(from), from.size(), to);
  const TracerFolder made(name, table);
  return problems_of_soil_folder(made.folder.path());
}

}  // namespace

TEST_CASE("Tracers: the tracers of a site are one target per direction", "[calibrate][soil_data]") {
  const TracerFolder made("good", header + good);
  const SoilData soil = load_soil(made.folder.path());
  std::vector<SoilTarget> found;
  for (const SoilTarget& t : soil.targets)
    if (t.test_id == "sweep_tillage") found.push_back(t);
  REQUIRE(found.size() == 6);
  CHECK(label(found[0]) == "sweep_tillage/forward_displacement_m/bin_A@0.05m_-0.1m");
  CHECK_THAT(found[0].value, WithinRel(0.14, 1e-12));
  CHECK_THAT(found[0].sigma, WithinRel(0.02 / std::sqrt(2.0), 1e-12));
  CHECK(found[0].origin.provenance == Provenance::synthetic);  // the worst of the two
  CHECK_THAT(found[1].value, WithinRel(-0.04, 1e-12));
  CHECK(found[1].observable_id == "lateral_displacement_m");
  CHECK(std::abs(found[2].value) < 1e-12);
  CHECK_FALSE(found[0].holdout);
  CHECK(found[3].holdout);
  CHECK(found[3].origin.provenance == Provenance::measured);
  const TestCondition* site = soil.condition(found[0].condition_id);
  REQUIRE(site);
  CHECK(site->number("tracer_depth_m") == 0.05);
  CHECK(site->number("tracer_lateral_m") == -0.1);
  CHECK(site->number("bulk_density_kg_per_m3") == 1450);  // of the plot
  // Six numbers of two sites are six observations.
  CHECK(num_independent_observations(found) == 3);  // three of them held out
}

TEST_CASE("Tracers: what is wrong is said with line and reason", "[calibrate][soil_data]") {
  CHECK(mentions(spoilt("plot", "bin_A,1,", "bin_B,1,"), {"tracers.csv:2", "unknown plotId 'bin_B'", "bin_A"}));
  CHECK(mentions(spoilt("depth", "1,0.05,-0.1", "1,50,-0.1"),
                 {"tracers.csv:2", "initial_depth_m = 50: must be in [0, 1]", "given in mm? write 0.05 m"}));
  CHECK(mentions(spoilt("unit", "-0.1,0.12,", "-0.1,120,"), {"forward_m = 120", "given in mm? write 0.12 m"}));
  CHECK(mentions(spoilt("nan", "-0.1,0.12,", "-0.1,nan,"), {"tracers.csv:2", "forward_m"}));
  CHECK(mentions(spoilt("sigma", "0.02,0,measured", "0,0,measured"), {"sigma_m = 0: must be > 0"}));
  CHECK(mentions(spoilt("twice", "bin_A,2,", "bin_A,1,"), {"tracers.csv:3", "'1' occurs twice in plot 'bin_A'"}));
  CHECK(mentions(spoilt("mixed", "0.02,0,synthetic", "0.02,1,synthetic"),
                 {"tracers.csv:3", "holdout differs from line 2"}));
  CHECK(mentions(spoilt("column", "sigma_m,", ""), {"tracers.csv", "sigma_m"}));
  CHECK(mentions(spoilt("provenance", ",measured,field book\nbin_A,2", ",guessed,field book\nbin_A,2"),
                 {"tracers.csv:2", "provenance"}));
}
