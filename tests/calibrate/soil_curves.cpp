// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Measured curves: what is wrong with one is said once, with its line; and the scatter regression.
#include <catch2/catch.hpp>
#include <cmath>

#include "calibrate/regression.hpp"
#include "calibrate/soil_data.hpp"
#include "tests/calibrate/soil_folder.hpp"

using namespace tilth;
using tilth::soil_test::mentions;
using tilth::soil_test::SoilFolder;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const std::string sand = "karlsruhe_fine_sand";

std::vector<std::string> spoilt(const std::string& name, const std::string& file,
                                const std::string& from, const std::string& to) {
  SoilFolder folder(sand, "curves_" + name);
  folder.replace(file, from, to);
  return problems_of_soil_folder(folder.path());
}

}  // namespace

TEST_CASE("Curves: the Karlsruhe sand has 18, whole and increasing", "[calibrate][soil_data]") {
  const SoilData soil = load_soil(soil_test::data_root() / "soils" / sand);
  REQUIRE(soil.curves.size() == 18);
  for (const MeasuredCurve& c : soil.curves) {
    CHECK(c.rows.size() == (c.condition_id == "TMD1" ? 200 : 201));
    CHECK_THAT(c.rows.back().front(), WithinAbs(0.2, 1e-12));
  }
}

TEST_CASE("Curves: strain that does not increase, a wrong unit and a missing cell pressure are refused",
          "[calibrate][soil_data]") {
  CHECK(mentions(spoilt("order", "curves.csv", "TMD1,0.003,", "TMD1,0.001,"),
                 {"curves.csv:5", "axial_strain = 0.001 after 0.002", "must increase"}));
  CHECK(mentions(spoilt("unit", "curves.csv", "0.000586,66560,50600", "0.000586,66560000,50600"),
                 {"curves.csv:3", "axial_stress_Pa", "1000 times too large"}));
  CHECK(mentions(spoilt("kPa", "curves.csv", "0.000586,66560,50600", "0.000586,66560,50.6"),
                 {"curves.csv:3", "radial_stress_Pa", "given in kPa? write 50600 Pa"}));
  CHECK(mentions(spoilt("cell", "conditions.csv", "TMD1,50600,", "TMD1,,"),
                 {"curves.csv:2", "needs cell_pressure_Pa", "conditions.csv:2"}));
  CHECK(mentions(spoilt("cell_of_target", "conditions.csv", "TMD2,100200,", "TMD2,,"),
                 {"measurements.csv", "needs cell_pressure_Pa with one number in condition 'TMD2'"}));
  CHECK(mentions(spoilt("other_cell", "conditions.csv", "TMD1,50600,", "TMD1,80600,"),
                 {"radial_stress_Pa begins at 50580", "cell_pressure_Pa of condition 'TMD1' is 80600"}));
  CHECK(mentions(spoilt("density", "conditions.csv", "TMD2,100200,0.209", "TMD2,100200,1.209"),
                 {"conditions.csv:3", "relative_density = 1.209: must be in [0, 1]"}));
  CHECK(mentions(spoilt("percent", "conditions.csv", "TMD2,100200,0.209", "TMD2,100200,20.9"),
                 {"relative_density = 20.9", "given in percent? write 0.209"}));
}

TEST_CASE("Curves: a wrong unit in a whole curve is one sentence", "[calibrate][soil_data]") {
  SoilFolder folder(sand, "curves_all_rows");
  std::string text = soil_test::read_text(folder.path() / "curves.csv");
  std::string spoilt_text;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    spoilt_text += line + (line.find(",TMD2,") != std::string::npos ? "000\n" : "\n");
  soil_test::write_text(folder.path() / "curves.csv", spoilt_text);
  const std::vector<std::string> problems = problems_of_soil_folder(folder.path());
  CHECK(mentions(problems, {"radial_stress_Pa", "and 200 more rows of this curve"}));
  CHECK(problems.size() == 2);  // and the first stress disagrees with the cell pressure
}

TEST_CASE("Regression: a plane is found and the scatter about it is sqrt(RSS / (n - k))",
          "[calibrate][regression]") {
  Eigen::MatrixXd x(4, 2);
  x << 1, 0, 1, 1, 1, 2, 1, 3;
  const Eigen::Vector4d noise(1, -1, -1, 1);  // orthogonal to both columns
  const Eigen::VectorXd y = x * Eigen::Vector2d(2, 3) + noise;
  const Regression r = regress(x, y);
  CHECK_THAT(r.coefficients[0], WithinAbs(2, 1e-12));
  CHECK_THAT(r.coefficients[1], WithinAbs(3, 1e-12));
  CHECK_THAT(r.scatter, WithinRel(std::sqrt(4.0 / 2.0), 1e-12));
  CHECK(r.degrees_of_freedom == 2);
  CHECK_THROWS_AS(regress(x.topRows(2), y.head(2)), std::invalid_argument);
}
