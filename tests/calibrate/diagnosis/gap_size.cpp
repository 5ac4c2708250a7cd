// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/gap_size.hpp"

#include <catch2/catch.hpp>

#include "tests/calibrate/diagnosis/small_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;

TEST_CASE("Gap: root mean square beyond noise, and the share that was closed",
          "[calibrate][diagnosis]") {
  const Eigen::Vector2d variances(0.01, 0.02);
  // ((0.25 - 0.01) + (0.09 - 0.02)) / 2 = 0.155
  REQUIRE_THAT(gap_size(Eigen::Vector2d(-0.5, 0.3), variances), WithinRel(std::sqrt(0.155), 1e-14));
  REQUIRE(gap_size(Eigen::Vector2d(0.05, -0.1), variances) == 0.0);
  REQUIRE(gap_size(Eigen::VectorXd(), Eigen::VectorXd()) == 0.0);
  REQUIRE_THAT(*closure(0.24, 0.09), WithinRel(0.625, 1e-14));
  REQUIRE_THAT(*closure(0.10, 0.15), WithinRel(-0.5, 1e-14));
  REQUIRE_FALSE(closure(0.0, 0.1).has_value());
}

TEST_CASE("Gap: noise alone is no gap on average", "[calibrate][diagnosis]") {
  std::mt19937_64 rng(1);
  const Eigen::VectorXd r = 0.1 * test::normal_matrix(20000, 1, rng);
  const Eigen::VectorXd v = Eigen::VectorXd::Constant(20000, 0.01);
  const Eigen::VectorXd shifted = r.array() + 0.2;
  // Mean of r^2 - V: standard error 0.01 sqrt(2 / 20000) = 1e-4, so below sqrt(4e-4); with a shift
  // of 0.2 the gap is 0.2, its standard error 0.5 % (2 * 0.2 * 0.1 / sqrt(20000) / 0.4).
  REQUIRE(gap_size(r, v) < 0.02);
  REQUIRE_THAT(gap_size(shifted, v), WithinAbs(0.2, 0.004));
}
