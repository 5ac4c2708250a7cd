// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/extrapolated_derivatives.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// exp(a), sin(a b), a^3 at (a, b)
Eigen::VectorXd curved(const Eigen::VectorXd& p) {
  return Eigen::Vector3d(std::exp(p[0]), std::sin(p[0] * p[1]), std::pow(p[0], 3));
}

const std::vector<Target> three = {log_target("x", 1.0, 1.0), log_target("y", 1.0, 1.0),
                                   log_target("z", 1.0, 1.0)};

std::vector<Target> plain() {
  std::vector<Target> targets = three;
  for (Target& t : targets) t.log_transform = false;
  return targets;
}

std::optional<Secants> derivatives(const std::vector<Parameter>& parameters,
                                   const Simulator& model) {
  SimulationLedger ledger;
  ledger.max_simulations = 1000;
  Evaluator evaluator(model, plain(), "search", ledger);
  const std::uint64_t seeds[] = {1};
  return extrapolated_derivatives(evaluator, parameters, plain(), unit_start(parameters), seeds);
}

}  // namespace

TEST_CASE("Extrapolated derivatives: nine digits inside the cube, seven at its edge",
          "[calibrate][derivatives]") {
  for (const double a : {0.7, 4.0}) {  // 4 is the upper bound: one-sided
    const std::vector<Parameter> parameters = {linear_parameter("a", -4.0, 4.0, a),
                                               linear_parameter("b", 0.0, 2.0, 1.3)};
    const auto found = derivatives(parameters, simulator_of(curved));
    REQUIRE(found);
    REQUIRE(found->frozen.empty());
    REQUIRE(found->one_sided.size() == (a == 4.0 ? 1 : 0));
    const double digits =
        a == 4.0 ? 1e-7 : 1e-9;  // powers of h are removed one by one, not in pairs
    CHECK_THAT(found->jacobian(0, 0) / 8.0, WithinRel(std::exp(a), digits));
    CHECK_THAT(found->jacobian(1, 0) / 8.0, WithinRel(1.3 * std::cos(1.3 * a), digits));
    CHECK_THAT(found->jacobian(2, 0) / 8.0, WithinRel(3.0 * a * a, digits));
    CHECK_THAT(found->jacobian(1, 1) / 2.0, WithinRel(a * std::cos(1.3 * a), 1e-9));
  }
}

TEST_CASE("Extrapolated derivatives: steps whose runs fail are left out",
          "[calibrate][derivatives]") {
  const std::vector<Parameter> parameters = {linear_parameter("a", -4.0, 4.0, 1.0),
                                             linear_parameter("b", 0.0, 2.0, 1.3)};
  const auto narrow = failing(simulator_of(curved),
                              [](const Eigen::VectorXd& p) { return std::abs(p[0] - 1.0) > 0.01; });
  const auto found = derivatives(parameters, narrow);
  REQUIRE(found);
  REQUIRE(found->frozen.empty());
  CHECK_THAT(found->jacobian(0, 0) / 8.0, WithinRel(std::exp(1.0), 1e-9));
  const auto blind =
      failing(simulator_of(curved), [](const Eigen::VectorXd& p) { return p[0] != 1.0; });
  CHECK(derivatives(parameters, blind)->frozen == std::vector<std::size_t>{0});
}
