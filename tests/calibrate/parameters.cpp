// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/parameters.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

TEST_CASE("Parameters: physical to unit and back is the identity on both scales",
          "[calibrate][parameters]") {
  for (const Parameter& p :
       {log_parameter("a_Pa", 1e3, 1e9, 1e5), linear_parameter("b", -2.0, 6.0, 0.0)}) {
    for (int i = 0; i <= 20; ++i) {
      const double unit = i / 20.0;
      const double value = physical_from_unit(p, unit);
      // 1e-13: exp(log(x)) near ln x = 20 keeps 52 - 5 bits.
      REQUIRE_THAT(unit_from_physical(p, value), WithinAbs(unit, 1e-13));
      REQUIRE_THAT(physical_from_coordinate(p, coordinate_from_physical(p, value)),
                   WithinRel(value, 1e-13) || WithinAbs(value, 1e-13));
    }
  }
}

TEST_CASE("Parameters: the unit interval ends exactly at the bounds", "[calibrate][parameters]") {
  const Parameter p = log_parameter("a_Pa", 0.1, 3.7e8, 1.0);
  REQUIRE(physical_from_unit(p, 0.0) == p.lower);
  REQUIRE(physical_from_unit(p, 1.0) == p.upper);
  REQUIRE(unit_from_physical(p, p.lower) == 0.0);
  REQUIRE(unit_from_physical(p, p.upper) == 1.0);
}

TEST_CASE("Parameters: half way on a log scale is the geometric mean", "[calibrate][parameters]") {
  // 1e-14: three roundings.
  REQUIRE_THAT(physical_from_unit(log_parameter("a", 1.0, 100.0, 2.0), 0.5),
               WithinRel(10.0, 1e-14));
  REQUIRE_THAT(physical_from_unit(linear_parameter("a", 1.0, 100.0, 2.0), 0.5),
               WithinRel(50.5, 1e-14));
}

TEST_CASE("Parameters: a fixed parameter reaches the simulator at its start value",
          "[calibrate][parameters]") {
  std::vector<Parameter> table = soil_parameters();
  table[1].estimate = false;
  const Eigen::VectorXd point = physical_point(table, Eigen::Vector2d(0.0, 1.0));
  REQUIRE(point[0] == table[0].lower);
  REQUIRE(point[1] == table[1].start);
  REQUIRE(point[2] == table[2].upper);
  REQUIRE(unit_start(table).size() == 2);
}

TEST_CASE("Parameters: all problems are listed at once, each with name and number",
          "[calibrate][parameters]") {
  std::vector<Parameter> table = {
      linear_parameter("turned", 2.0, 1.0, 1.5), linear_parameter("outside", 0.0, 1.0, 7.0),
      log_parameter("negative", -1.0, 1.0, 0.5), linear_parameter("outside", 0.0, 1.0, 0.5),
      linear_parameter("nan", 0.0, 1.0, 0.5)};
  table[4].upper = std::numeric_limits<double>::quiet_NaN();
  table[3].prior_mean = 0.5;
  const std::vector<std::string> found = problems(table);
  REQUIRE(found.size() == 6);
  REQUIRE_THAT(found[0], Contains("turned") && Contains("less than"));
  REQUIRE_THAT(found[1], Contains("outside") && Contains("start = 7"));
  REQUIRE_THAT(found[2], Contains("negative") && Contains("log scale"));
  REQUIRE_THAT(found[3], Contains("twice"));
  REQUIRE_THAT(found[4], Contains("prior_sigma"));
  REQUIRE_THAT(found[5], Contains("finite"));
  REQUIRE(problems(soil_parameters()).empty());
}
