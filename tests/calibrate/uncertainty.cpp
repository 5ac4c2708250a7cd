// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/uncertainty.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using namespace tilth;
using namespace tilth::test;

TEST_CASE("Uncertainty: with independent residuals it is the inverse of J'J",
          "[calibrate][uncertainty]") {
  Eigen::MatrixXd j(4, 2);
  j << 30, 1, 5, 20, -7, 3, 2, 2;
  const LinearUncertainty found = linear_uncertainty(j, Eigen::MatrixXd::Identity(4, 4));
  const Eigen::MatrixXd exact = (j.transpose() * j).inverse();
  // 1e-13 relative: condition of J is 2.
  REQUIRE((found.covariance - exact).norm() < 1e-13 * exact.norm());
  REQUIRE(found.null_space.cols() == 0);
}

TEST_CASE("Uncertainty: residuals that move together do not average out",
          "[calibrate][uncertainty]") {
  const Eigen::MatrixXd j = Eigen::MatrixXd::Constant(4, 1, 10.0);
  const Eigen::MatrixXd together = Eigen::MatrixXd::Constant(4, 4, 1.0);
  // Four independent looks: 1 / (4 * 100). Four times the same look: 1 / 100. 1e-15: rounding.
  REQUIRE(std::abs(linear_uncertainty(j, Eigen::MatrixXd::Identity(4, 4)).covariance(0, 0) -
                   0.0025) < 1e-15);
  REQUIRE(std::abs(linear_uncertainty(j, together).covariance(0, 0) - 0.01) < 1e-15);
}

TEST_CASE("Uncertainty: a product that is measured leaves the quotient free, and says so",
          "[calibrate][uncertainty]") {
  const std::vector<Parameter> parameters = {log_parameter("a", 1.0, 10.0, 2.0),
                                             log_parameter("b", 1.0, 10.0, 2.0),
                                             log_parameter("c", 1.0, 10.0, 2.0)};
  Eigen::MatrixXd j(3, 3);  // two looks at ln(a b), one at ln c
  j << 50, 50, 0, 20, 20, 0, 0, 0, 30;
  const LinearUncertainty found = linear_uncertainty(j, Eigen::MatrixXd::Identity(3, 3));
  REQUIRE(found.null_space.cols() == 1);
  REQUIRE(found.null_share[0] > 0.4);
  REQUIRE(found.null_share[2] < 1e-12);
  REQUIRE_THAT(describe_null_direction(parameters, found.null_space.col(0)),
               Equals("the data do not fix a / b") || Equals("the data do not fix b / a"));
  REQUIRE_THAT(describe_null_direction(parameters, Eigen::Vector3d(0.5, 1.0, 0.0)),
               Equals("the data do not fix b x a^0.5"));
}

TEST_CASE("Uncertainty: linear parameters are described in units of their ranges",
          "[calibrate][uncertainty]") {
  const std::vector<Parameter> parameters = {linear_parameter("a", 0.0, 10.0, 2.0),
                                             log_parameter("b", 1.0, 10.0, 2.0)};
  REQUIRE_THAT(describe_null_direction(parameters, Eigen::Vector2d(1.0, -0.5)),
               Contains("a - 0.5 b") && Contains("range"));
}

TEST_CASE("Uncertainty: fewer residuals than parameters leave null directions, no crash",
          "[calibrate][uncertainty]") {
  const Eigen::MatrixXd j = Eigen::RowVector3d(40.0, 0.0, 0.0);
  const LinearUncertainty found = linear_uncertainty(j, Eigen::MatrixXd::Identity(1, 1));
  REQUIRE(found.null_space.cols() == 2);
  REQUIRE(std::abs(found.covariance(0, 0) - 1.0 / 1600.0) < 1e-15);
  // A direction whose 95 % interval is longer than the cube is not fixed either: 1.96 sigma.
  REQUIRE(linear_uncertainty(Eigen::MatrixXd::Constant(1, 1, 1.9), Eigen::MatrixXd::Identity(1, 1))
              .null_space.cols() == 1);
  REQUIRE(linear_uncertainty(Eigen::MatrixXd::Constant(1, 1, 2.0), Eigen::MatrixXd::Identity(1, 1))
              .null_space.cols() == 0);
}

TEST_CASE("Uncertainty: a small share of a null direction that outweighs the error bar forbids it",
          "[calibrate][uncertainty]") {
  // y = a - 100 b in the cube: along the null direction (1, 0.01) b moves by 0.01 only, but its
  // error bar, which leaves that direction out, is 1 / 10000.
  const Eigen::MatrixXd j = Eigen::RowVector2d(-100.0, 10000.0);
  const LinearUncertainty found = linear_uncertainty(j, Eigen::MatrixXd::Identity(1, 1));
  REQUIRE(found.null_share[1] < max_null_share);
  REQUIRE_FALSE(found.is_fixed(0));
  REQUIRE_FALSE(found.is_fixed(1));
  const Eigen::MatrixXd apart = Eigen::Vector2d(0.0, 100.0).asDiagonal();
  REQUIRE(linear_uncertainty(apart, Eigen::MatrixXd::Identity(2, 2)).is_fixed(1));
}

TEST_CASE("Uncertainty: noise of the derivatives is taken out of J'J and lengthens the error bar",
          "[calibrate][uncertainty]") {
  Eigen::MatrixXd j(4, 2);
  j << 30, 1, 5, 20, -7, 3, 2, 2;
  Eigen::MatrixXd noise(2, 2);
  noise << 200, 30, 30, 90;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(4, 4);
  const LinearUncertainty found = linear_uncertainty(j, identity, 1e-3, noise);
  const Eigen::MatrixXd signal = (j.transpose() * j - noise).inverse();
  const Eigen::MatrixXd exact = signal * j.transpose() * j * signal;
  REQUIRE((found.covariance - exact).norm() < 1e-13 * exact.norm());
  const LinearUncertainty naive = linear_uncertainty(j, identity);
  REQUIRE(std::abs(found.noise_factor[1] - std::sqrt(exact(1, 1) / naive.covariance(1, 1))) < 1e-13);
  REQUIRE(naive.noise_factor == Eigen::Vector2d::Ones());
}

TEST_CASE("Uncertainty: derivatives that noise alone explains fix nothing", "[calibrate][uncertainty]") {
  const Eigen::MatrixXd j = Eigen::Vector2d(40.0, 20.0).asDiagonal();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(2, 2);
  const auto with_noise = [&](double of_second) {
    const Eigen::MatrixXd noise = Eigen::Vector2d(0.0, of_second).asDiagonal();
    return linear_uncertainty(j, identity, 1e-3, noise);
  };
  REQUIRE(with_noise(401.0).num_drowned == 1);
  REQUIRE(with_noise(401.0).null_share[1] == Approx(1.0));
  REQUIRE(with_noise(401.0).is_fixed(0));
  // A share of the signal of 1/2: J'J = 400 is 200 of signal; of less than 1/3: trebled, no more.
  REQUIRE(with_noise(200.0).covariance(1, 1) == Approx(400.0 / (200.0 * 200.0)));
  REQUIRE(with_noise(390.0).covariance(1, 1) == Approx(9.0 / 400.0));
}
