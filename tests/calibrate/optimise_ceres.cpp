// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/optimise_ceres.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <utility>

using Catch::Matchers::WithinAbs;
using namespace tilth;

namespace {

// Rosenbrock as two residuals: r = (1 - x, 10 (y - x^2)), minimum 0 at (1, 1).
LeastSquaresProblem rosenbrock() {
  LeastSquaresProblem problem;
  problem.lower = Eigen::Vector2d(-10.0, -10.0);
  problem.upper = Eigen::Vector2d(10.0, 10.0);
  problem.num_residuals = 2;
  problem.evaluate = [](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    r << 1.0 - x[0], 10.0 * (x[1] - x[0] * x[0]);
    if (j != nullptr) *j << -1.0, 0.0, -20.0 * x[0], 10.0;
    return true;
  };
  return problem;
}

LeastSquaresOptions tight() {
  LeastSquaresOptions options;
  options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-14;
  return options;
}

const Eigen::Vector2d start(-1.2, 1.0);

}  // namespace

TEST_CASE("Ceres: Rosenbrock's valley is followed to its end", "[calibrate][ceres]") {
  const LeastSquaresResult found = minimise_with_ceres(rosenbrock(), start, tight());
  REQUIRE(found.usable);
  REQUIRE(found.converged);
  // 1e-8: zero-residual problem, quadratic convergence to rounding.
  REQUIRE_THAT(found.x[0], WithinAbs(1.0, 1e-8));
  REQUIRE_THAT(found.x[1], WithinAbs(1.0, 1e-8));
  // (1 + 1.2)^2 + 100 (1 - 1.44)^2 = 24.2; 1e-12: rounding.
  REQUIRE_THAT(found.sum_of_squares_start, WithinAbs(24.2, 1e-12));
  REQUIRE(found.history.size() == static_cast<std::size_t>(found.num_iterations) + 1);
}

TEST_CASE("Ceres: a step too short to be judged ends the search without a run", "[calibrate][ceres]") {
  // A parabola with a step of noise in it: trial points are rejected ever nearer to the last one.
  int num_trials = 0;
  LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Zero(1);
  problem.upper = Eigen::VectorXd::Ones(1);
  problem.num_residuals = 1;
  problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
    r = Eigen::VectorXd::Constant(1, 2.0 - x[0] + (x[0] == 0.5 ? 0.0 : 1.0));
    if (jacobian != nullptr) *jacobian = Eigen::MatrixXd::Constant(1, 1, -1.0);
    else ++num_trials;
    return true;
  };
  LeastSquaresOptions options;
  options.least_step = 0.01;
  const LeastSquaresResult found =
      minimise_with_ceres(problem, Eigen::VectorXd::Constant(1, 0.5), options);
  CHECK(found.usable);
  CHECK(found.converged);
  CHECK(found.x[0] == 0.5);
  const int with_rule = std::exchange(num_trials, 0);
  options.least_step = 0.0;
  minimise_with_ceres(problem, Eigen::VectorXd::Constant(1, 0.5), options);
  CHECK(with_rule < num_trials);
}

TEST_CASE("Ceres: a bound is met exactly and the rest is minimised on it", "[calibrate][ceres]") {
  LeastSquaresProblem problem = rosenbrock();
  problem.upper[0] = 0.5;
  const LeastSquaresResult found = minimise_with_ceres(problem, start, tight());
  INFO(found.message);
  REQUIRE(found.converged);
  REQUIRE(found.x[0] == 0.5);
  // On x = 1/2 the minimum is y = 1/4 with r = (1/2, 0); 1e-6: projected steps end by step size.
  REQUIRE_THAT(found.x[1], WithinAbs(0.25, 1e-6));
  REQUIRE_THAT(found.sum_of_squares, WithinAbs(0.25, 1e-10));
}

TEST_CASE("Ceres: where the cost cannot be evaluated the search backs off and goes on",
          "[calibrate][ceres]") {
  LeastSquaresProblem problem = rosenbrock();
  int refusals = 0;
  const auto whole = problem.evaluate;
  problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    if (x[1] < -0.5) {  // the first Gauss-Newton step lands at y = -3.8
      ++refusals;
      return false;
    }
    return whole(x, r, j);
  };
  const LeastSquaresResult found = minimise_with_ceres(problem, start, tight());
  REQUIRE(refusals > 0);
  REQUIRE_THAT(found.x[0], WithinAbs(1.0, 1e-8));
}

TEST_CASE("Ceres: nothing but the start can be evaluated: the start is the result",
          "[calibrate][ceres]") {
  LeastSquaresProblem problem = rosenbrock();
  const auto whole = problem.evaluate;
  problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    return x == start && whole(x, r, j);
  };
  const LeastSquaresResult alone = minimise_with_ceres(problem, start, tight());
  REQUIRE(alone.usable);
  REQUIRE(alone.x == start);
  problem.evaluate = [](const auto&, auto&, auto*) { return false; };
  REQUIRE_FALSE(minimise_with_ceres(problem, start, tight()).usable);
}

TEST_CASE("Ceres: a stop keeps the best point, and the Jacobian is never asked on trial points",
          "[calibrate][ceres]") {
  LeastSquaresProblem problem = rosenbrock();
  int jacobians = 0;
  const auto whole = problem.evaluate;
  problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    jacobians += j != nullptr ? 1 : 0;
    return whole(x, r, j);
  };
  LeastSquaresOptions options = tight();
  int asked = 0;
  options.should_stop = [&] { return ++asked > 4; };
  const LeastSquaresResult found = minimise_with_ceres(problem, start, options);
  REQUIRE_FALSE(found.converged);
  REQUIRE(found.usable);
  REQUIRE(found.sum_of_squares < found.sum_of_squares_start);
  // Once before the search, to see whether the start can be evaluated, then once per point kept.
  REQUIRE(jacobians <= found.num_iterations + 2);
}

TEST_CASE("Ceres: an exception of the cost reaches the caller", "[calibrate][ceres]") {
  LeastSquaresProblem problem = rosenbrock();
  problem.evaluate = [](const auto&, auto&, auto*) -> bool { throw std::runtime_error("disk"); };
  REQUIRE_THROWS_WITH(minimise_with_ceres(problem, start, tight()), "disk");
}
