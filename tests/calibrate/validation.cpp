// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/validation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

/// y = a b with a on a log scale and b on a linear one.
Eigen::VectorXd product(const Eigen::VectorXd& p) { return Eigen::VectorXd::Constant(1, p[0] * p[1]); }

ValidationProblem problem_of(double target) {
  ValidationProblem problem;
  problem.parameters = {log_parameter("a", 1.0, 100.0, 10.0), linear_parameter("b", 0.0, 4.0, 2.0)};
  problem.covariance = Eigen::Matrix2d{{0.04, 0.006}, {0.006, 0.01}};
  problem.targets = {log_target("y", target, 0.1)};
  problem.seeds = {4001, 4002};
  return problem;
}

}  // namespace

TEST_CASE("Validation: the interval holds measurement, packings and parameters, correlation included",
          "[calibrate][validation]") {
  const Validation v = validate(problem_of(30.0), simulator_of(product));
  // d ln y / d ln a = 1, d ln y / d b = 1 / 2: 0.04 + 2 0.5 0.006 + 0.25 0.01; the secant in b is
  // curved by (h / b)^2 / 3 with h = 0.32
  const double by_parameters = std::sqrt(0.04 + 2 * 0.5 * 0.006 + 0.25 * 0.01);
  REQUIRE(v.targets.size() == 1);
  CHECK_THAT(v.targets[0].parameter_sd, WithinRel(by_parameters, 0.01));
  CHECK_THAT(v.targets[0].sigma_total, WithinRel(std::hypot(0.1, by_parameters), 0.01));
  CHECK_THAT(v.targets[0].residual, WithinRel(std::log(20.0 / 30.0) / std::hypot(0.1, by_parameters), 0.01));
  CHECK(v.targets[0].simulated == Approx(20.0));
  CHECK(v.num_simulations == 2 + 4);  // two packings, and four around the first
  CHECK(v.passed());
}

TEST_CASE("Validation: the pass mark is the root mean square residual", "[calibrate][validation]") {
  ValidationProblem far = problem_of(60.0);
  const Validation v = validate(far, simulator_of(product));
  CHECK(v.rms == Approx(std::abs(v.targets[0].residual)));
  CHECK_FALSE(v.passed());
  far.limit = 100.0;
  CHECK(validate(far, simulator_of(product)).passed());
}

TEST_CASE("Validation: failed packings are left out and recorded, none left is no number", "[calibrate][validation]") {
  ValidationProblem problem = problem_of(20.0);
  problem.covariance.resize(0, 0);
  const Simulator one_fails = [](const Eigen::MatrixXd& p, std::span<const std::uint64_t> seeds) {
    std::vector<Evaluation> runs = simulator_of(product)(p, seeds);
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (seeds[i] == 4002) runs[i] = {EvaluationStatus::failed, {}, "exploded"};
    return runs;
  };
  const Validation v = validate(problem, one_fails);
  CHECK(v.num_seeds == 1);
  CHECK(v.failures.size() == 1);
  CHECK_FALSE(v.has_parameter_errors);
  // one packing has no scatter: not known, which is not zero
  CHECK(std::isnan(v.targets[0].seed_sd));
  CHECK(std::isnan(v.targets[0].parameter_sd));
  CHECK_THAT(v.targets[0].sigma_total, WithinRel(0.1, 1e-12));
  const Validation none = validate(problem, failing(simulator_of(product), [](const auto&) { return true; }));
  CHECK(std::isnan(none.rms));
  CHECK_FALSE(none.passed());
}
