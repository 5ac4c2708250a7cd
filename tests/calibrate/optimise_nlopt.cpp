// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/optimise_nlopt.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

using Catch::Matchers::WithinAbs;
using namespace tilth;

namespace {

constexpr double pi = std::numbers::pi;

// Branin's function (Dixon & Szego 1978): three minima, all 5 / (4 pi) = 0.397887...
double branin(const Eigen::VectorXd& x) {
  const double b = x[1] - 5.1 / (4.0 * pi * pi) * x[0] * x[0] + 5.0 / pi * x[0] - 6.0;
  return b * b + 10.0 * (1.0 - 1.0 / (8.0 * pi)) * std::cos(x[0]) + 10.0;
}

const Eigen::Vector2d lower(-5.0, 0.0);
const Eigen::Vector2d upper(10.0, 15.0);
const Eigen::Vector2d start(2.0, 8.0);

}  // namespace

TEST_CASE("NLopt: every algorithm finds a minimum of Branin's function", "[calibrate][nlopt]") {
  for (const NloptAlgorithm algorithm :
       {NloptAlgorithm::direct_l, NloptAlgorithm::crs2, NloptAlgorithm::isres,
        NloptAlgorithm::sbplx, NloptAlgorithm::bobyqa}) {
    const NloptResult found =
        minimise_with_nlopt(branin, lower, upper, start, {algorithm, 5000, 1e-7, 1});
    // 1e-3: global searches end near the bottom of a valley of curvature ~1, not at it.
    REQUIRE_THAT(found.value, WithinAbs(5.0 / (4.0 * pi), 1e-3));
    REQUIRE(branin(found.x) == found.value);
    REQUIRE((found.x.array() >= lower.array()).all());
    REQUIRE((found.x.array() <= upper.array()).all());
    REQUIRE(found.num_evaluations <= 5001);
  }
}

TEST_CASE("NLopt: equal seeds give equal bits, whatever ran before", "[calibrate][nlopt]") {
  const auto run = [](std::uint64_t seed) {
    return minimise_with_nlopt(branin, lower, upper, start,
                               {NloptAlgorithm::crs2, 300, 1e-7, seed});
  };
  const NloptResult first = run(5);
  run(6);
  REQUIRE(run(5).x == first.x);
  REQUIRE(run(6).x != first.x);
}

TEST_CASE("NLopt: the best point survives an evaluation limit, NaN regions and a bad start",
          "[calibrate][nlopt]") {
  const NloptResult cut =
      minimise_with_nlopt(branin, lower, upper, start, {NloptAlgorithm::sbplx, 10, 1e-7, 1});
  REQUIRE_FALSE(cut.converged);
  REQUIRE(cut.value <= branin(start));

  const auto holed = [](const Eigen::VectorXd& x) {
    return x[0] > 5.0 ? std::numeric_limits<double>::quiet_NaN() : branin(x);
  };
  for (const NloptAlgorithm algorithm :
       {NloptAlgorithm::direct_l, NloptAlgorithm::crs2, NloptAlgorithm::isres,
        NloptAlgorithm::sbplx, NloptAlgorithm::bobyqa}) {
    const NloptResult around =
        minimise_with_nlopt(holed, lower, upper, start, {algorithm, 5000, 1e-7, 1});
    INFO(static_cast<int>(algorithm) << ": " << around.message);
    REQUIRE_THAT(around.value, WithinAbs(5.0 / (4.0 * pi), 1e-3));  // as above
  }

  const NloptResult refused = minimise_with_nlopt(holed, lower, upper, Eigen::Vector2d(9.0, 1.0),
                                                  {NloptAlgorithm::crs2, 100, 1e-7, 1});
  REQUIRE(std::isnan(refused.value));
  REQUIRE(refused.num_evaluations == 1);
}

TEST_CASE("NLopt: an exception of the objective reaches the caller", "[calibrate][nlopt]") {
  int calls = 0;
  const auto throwing = [&calls](const Eigen::VectorXd& x) {
    if (++calls == 5) throw std::runtime_error("fifth");
    return branin(x);
  };
  REQUIRE_THROWS_WITH(minimise_with_nlopt(throwing, lower, upper, start, NloptOptions{}), "fifth");
}
