// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/curve_features.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace tilth;
using Catch::Matchers::WithinRel;

namespace {

Curve curve(std::vector<std::vector<double>> rows) { return {"c", {"x", "y"}, std::move(rows)}; }

constexpr double rounding = 1e-14;

}  // namespace

TEST_CASE("Curve: the first of several equal peaks counts", "[experiments][curve]") {
  REQUIRE(row_of_largest(curve({{0, 1}, {1, 3}, {2, 2}, {3, 3}}), 1) == 1);
  REQUIRE(row_of_largest(curve({{0, -4}, {1, -3}}), 1) == 1);
}

TEST_CASE("Curve: a crossing is interpolated between rows and from the origin",
          "[experiments][curve]") {
  const Curve c = curve({{1, 2}, {2, 4}, {3, 3}, {4, 8}});
  REQUIRE_THAT(first_crossing(c, 0, 1, 1, 0, 4), WithinRel(0.5, rounding));
  REQUIRE_THAT(first_crossing(c, 0, 1, 3, 0, 4), WithinRel(1.5, rounding));
  REQUIRE_THAT(first_crossing(c, 0, 1, 5, 0, 4), WithinRel(3.4, rounding));
  REQUIRE_THAT(first_crossing(c, 0, 1, 3.5, 2, 4), WithinRel(3.1, rounding));
  // Searching begins above the level: the first row, since what lies before is not looked at.
  REQUIRE_THAT(first_crossing(c, 0, 1, 3, 1, 4), WithinRel(2, rounding));
  REQUIRE(std::isnan(first_crossing(c, 0, 1, 9, 0, 4)));
  REQUIRE(std::isnan(first_crossing(c, 0, 1, 5, 0, 3)));
  REQUIRE(std::isnan(first_crossing(c, 0, 1, 1, 2, 2)));
}

TEST_CASE("Curve: the secant of y = a sqrt(x) at a share of its end is a / (share sqrt(x_end))",
          "[experiments][curve]") {
  Curve c = curve({});
  for (int k = 1; k <= 4000; ++k) c.rows.push_back({k * 1e-3, 6 * std::sqrt(k * 1e-3)});
  c.rows.push_back({5, 1});  // beyond `last`: must not matter
  // 1e-6: interpolation errs by step^2 / (8 x^2) = 1.3e-7 at x = 1.
  REQUIRE_THAT(secant_at_share(c, 0, 1, 3999, 0.5), WithinRel(6.0, 1e-6));
  REQUIRE_THAT(secant_at_share(c, 0, 1, 3999, 1.0), WithinRel(3.0, 1e-6));
  const Curve line = curve({{0.3, 0.6}, {0.7, 1.4}, {1.1, 2.2}});
  for (const double share : {0.1, 0.5, 0.9})
    REQUIRE_THAT(secant_at_share(line, 0, 1, 2, share), WithinRel(2.0, rounding));
}

TEST_CASE("Curve: mean and straight line have their closed forms", "[experiments][curve]") {
  REQUIRE_THAT(mean_of(curve({{0, 1}, {0, 2}, {0, 6}, {0, 9}}), 1, 1, 3), WithinRel(4.0, rounding));
  // The last quarter of nine rows is two of them; of three rows it is the last one.
  REQUIRE_THAT(mean_of_last_quarter(
                   curve({{0, 9}, {0, 9}, {0, 9}, {0, 9}, {0, 9}, {0, 9}, {0, 9}, {0, 2}, {0, 4}}), 1),
               WithinRel(3.0, rounding));
  REQUIRE_THAT(mean_of_last_quarter(curve({{0, 1}, {0, 2}, {0, 6}}), 1), WithinRel(6.0, rounding));
  const Line exact = fit_line({10e3, 20e3, 40e3}, {8e3, 13e3, 23e3});
  REQUIRE_THAT(exact.slope, WithinRel(0.5, 1e-12));
  REQUIRE_THAT(exact.intercept, WithinRel(3e3, 1e-12));
  // Points (0,0), (1,3), (2,0): slope 0 by symmetry, intercept their mean.
  const Line fitted = fit_line({0, 1, 2}, {0, 3, 0});
  REQUIRE(std::abs(fitted.slope) < rounding);
  REQUIRE_THAT(fitted.intercept, WithinRel(1.0, rounding));
}
