// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/targets.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

TEST_CASE("Targets: a number derived from another is not a second observation",
          "[calibrate][targets]") {
  std::vector<Target> targets = soil_targets(0.1, 0);
  targets[2].observation_group = "stress curve";
  targets[3].observation_group = "stress curve";
  targets[5].holdout = true;
  REQUIRE(num_independent_observations(targets) == 4);
  REQUIRE(fitted_targets(targets) == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("Targets: sigma_total adds the variances of measurement, packings and bias",
          "[calibrate][targets]") {
  // 3^2 + 32 / 2 + 144 = 13^2; 1e-15: one rounding.
  REQUIRE_THAT(total_sigma(3.0, 32.0, 2, 144.0), WithinRel(13.0, 1e-15));
}

TEST_CASE("Targets: the transformation has an inverse and refuses logarithms of nothing",
          "[calibrate][targets]") {
  const Target t = log_target("a_Pa", 10.0, 0.1);
  REQUIRE_THAT(untransformed(t, transformed(t, 3.5)), WithinRel(3.5, 1e-15));
  REQUIRE(std::isnan(transformed(t, 0.0)));
}

TEST_CASE("Targets: all problems are listed at once", "[calibrate][targets]") {
  std::vector<Target> targets = {log_target("a", -1.0, 0.1), log_target("a", 1.0, 0.0)};
  REQUIRE(problems(targets).size() == 3);  // not positive; sigma; name twice
  for (Target& target : targets) target.holdout = true;
  REQUIRE(problems(targets).size() == 4);  // nothing to fit
  REQUIRE(problems(soil_targets(0.1, 0)).empty());
}
