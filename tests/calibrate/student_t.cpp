// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/student_t.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using Catch::Matchers::WithinRel;
using namespace tilth;

TEST_CASE("Student t: half-widths agree with published quantiles", "[calibrate][student_t]") {
  // 1e-12: bisection to rounding; closed forms for 1 and 2, else as many digits as published.
  REQUIRE_THAT(student_t_half_width(0.95, 1), WithinRel(std::tan(0.475 * std::numbers::pi), 1e-12));
  REQUIRE_THAT(student_t_half_width(0.95, 2), WithinRel(0.95 * std::sqrt(2.0 / 0.0975), 1e-12));
  REQUIRE_THAT(student_t_half_width(0.95, 3), WithinRel(3.182446305, 1e-9));
  REQUIRE_THAT(student_t_half_width(0.95, 28), WithinRel(2.0484071417952, 1e-12));
  // The normal limit differs by (z + z^3) / (4 freedom) = 2.4e-6 here.
  REQUIRE_THAT(student_t_half_width(0.95, 1'000'000), WithinRel(1.959963984540054, 2e-6));
  REQUIRE_THAT(student_t_central_probability(student_t_half_width(0.9, 7), 7),
               WithinRel(0.9, 1e-13));
}
