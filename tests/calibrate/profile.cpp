// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Profile likelihoods and what is read from them.
#include "calibrate/profile.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "calibrate/equivalence_family.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;

namespace {

// r = A (u - centre) in the unit cube.
LeastSquaresProblem linear_problem(const Eigen::MatrixXd& a, const Eigen::VectorXd& centre) {
  LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Zero(a.cols());
  problem.upper = Eigen::VectorXd::Ones(a.cols());
  problem.num_residuals = static_cast<int>(a.rows());
  problem.evaluate = [a, centre](const Eigen::VectorXd& u, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    r = a * (u - centre);
    if (j != nullptr) *j = a;
    return true;
  };
  return problem;
}

// One residual f(u) with slope by differences.
LeastSquaresProblem one_residual(std::function<double(double)> f) {
  LeastSquaresProblem problem =
      linear_problem(Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Zero(1));
  problem.evaluate = [f](const Eigen::VectorXd& u, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    r[0] = f(u[0]);
    if (j != nullptr) (*j)(0, 0) = (f(u[0] + 1e-6) - f(u[0] - 1e-6)) / 2e-6;
    return true;
  };
  return problem;
}

const Eigen::MatrixXd no_candidates2(2, 0);

double least_of(const Profile& profile) {
  double least = profile.front().chi_square;
  for (const ProfilePoint& p : profile) least = std::min(least, p.chi_square);
  return least;
}

ProfileReading read(const Profile& profile, int held) {
  return read_profile(profile, held, least_of(profile), chi_square_95);
}

}  // namespace

TEST_CASE("Profile: of a linear model it is the parabola of the covariance",
          "[calibrate][profile]") {
  Eigen::MatrixXd a(3, 2);
  a << 30, 10, 5, 25, 8, -4;
  const Eigen::Vector2d centre(0.5, 0.6);
  const Eigen::Matrix2d covariance = (a.transpose() * a).inverse();
  const double error = std::sqrt(covariance(0, 0));
  const Profile profile =
      draw_profile(linear_problem(a, centre), centre, 0, error, no_candidates2, {});
  int num_inside = 0;
  for (const ProfilePoint& p : profile) {
    const double steps = (p.unit[0] - 0.5) / error;
    if (p.at_bound >= 0) continue;  // far out the other parameter stops following
    ++num_inside;
    // Both steps of the restricted search are exact; 1e-5 of the level is its stopping rule.
    CHECK_THAT(p.chi_square, WithinAbs(steps * steps, 1e-4));
  }
  REQUIRE(num_inside > 10);
  const ProfileReading reading = read(profile, 0);
  REQUIRE(reading.verdict == ParameterVerdict::identified);
  CHECK_THAT(reading.low, WithinAbs(0.5 - 1.959963984540054 * error, 1e-6));
  CHECK_THAT(reading.high, WithinAbs(0.5 + 1.959963984540054 * error, 1e-6));
}

TEST_CASE("Profile: crossed on one side it is one-sided, on none it is flat",
          "[calibrate][profile]") {
  const Eigen::VectorXd near_edge = Eigen::VectorXd::Constant(1, 0.1);
  const Eigen::MatrixXd none(1, 0);
  const auto reading = [&](double slope) {
    return read(draw_profile(linear_problem(Eigen::MatrixXd::Constant(1, 1, slope), near_edge),
                             near_edge, 0, not_known, none, {}),
                0);
  };
  CHECK(reading(30.0).verdict == ParameterVerdict::identified);  // 0.1 is three errors of 1/30
  const ProfileReading one = reading(10.0);
  CHECK(one.verdict == ParameterVerdict::one_sided);
  CHECK(std::isnan(one.low));
  CHECK_THAT(one.high, WithinAbs(0.1 + 0.1959963984540054, 1e-6));
  CHECK(reading(1.0).verdict == ParameterVerdict::flat);
}

TEST_CASE("Profile: a drop that only another parameter's bound causes names that parameter",
          "[calibrate][profile]") {
  // Only u0 - u1 shows: u0 moves freely until u1 runs into 0 or 1.
  const Eigen::Vector2d centre(0.5, 0.7);
  const Eigen::MatrixXd a = Eigen::RowVector2d(40.0, -40.0);
  const Profile profile =
      draw_profile(linear_problem(a, centre), centre, 0, not_known, no_candidates2, {});
  const ProfileReading reading = read(profile, 0);
  REQUIRE(reading.verdict == ParameterVerdict::bound_limited);
  CHECK(reading.limited_by == 1);
  // u1 reaches 1 at u0 = 0.8; one residual of 40 crosses the level 1.96 / 40 later. u1 = 0 is never
  // reached: the other end is open. 1e-3: kinked at the bound, so the square root bends.
  CHECK_THAT(reading.high, WithinAbs(0.8 + 1.96 / 40.0, 1e-3));
  CHECK(std::isnan(reading.low));
  for (const ProfilePoint& p : profile) {
    CHECK(p.at_bound == (p.unit[0] > 0.8 + 1e-6 ? 1 : -1));
    CHECK(p.if_lifted < 1e-6);
  }
}

TEST_CASE("Profile: another parameter at its bound that hardly matters changes no verdict",
          "[calibrate][profile]") {
  // u1 wants to be 1.1 and is held at 1; u0 has its own residual and a weak coupling.
  Eigen::MatrixXd a(2, 2);
  a << 40.0, 4.0, 0.0, 40.0;
  const Eigen::Vector2d wanted(0.5, 1.1);
  const Eigen::Vector2d optimum(0.51, 1.0);
  const Profile profile =
      draw_profile(linear_problem(a, wanted), optimum, 0, 0.025, no_candidates2, {});
  CHECK(read(profile, 0).verdict == ParameterVerdict::identified);
  CHECK(profile.back().at_bound == 1);
}

TEST_CASE("Profile: two separate regions are multimodal, with and without candidates",
          "[calibrate][profile]") {
  const auto two_wells = one_residual([](double u) { return 40.0 * (u - 0.25) * (u - 0.75); });
  const Eigen::VectorXd optimum = Eigen::VectorXd::Constant(1, 0.25);
  const Profile profile = draw_profile(two_wells, optimum, 0, 0.05, Eigen::MatrixXd(1, 0), {});
  CHECK(read(profile, 0).verdict == ParameterVerdict::multimodal);
  // A second region reached only from elsewhere: u1 sits in the wrong well all along the walk.
  LeastSquaresProblem hidden = linear_problem(Eigen::MatrixXd::Ones(2, 2), Eigen::Vector2d::Zero());
  hidden.evaluate = [](const Eigen::VectorXd& u, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    const double well = u[1] < 0.5 ? u[0] - 0.2 : u[0] - 0.8;
    r = Eigen::Vector2d(20.0 * well, 100.0 * (u[1] - 0.1) * (u[1] - 0.9));
    if (j != nullptr) *j << 20.0, 0.0, 0.0, 100.0 * (2.0 * u[1] - 1.0);
    return true;
  };
  const Eigen::Vector2d start(0.2, 0.1);
  CHECK(read(draw_profile(hidden, start, 0, 0.05, no_candidates2, {}), 0).verdict ==
        ParameterVerdict::identified);
  const Eigen::MatrixXd candidates = Eigen::Vector2d(0.8, 0.85);
  CHECK(read(draw_profile(hidden, start, 0, 0.05, candidates, {}), 0).verdict ==
        ParameterVerdict::multimodal);
}

TEST_CASE("Equivalence family: the farthest points come first, near twins never",
          "[calibrate][profile]") {
  Eigen::MatrixXd points(2, 5);
  points << 0.0, 0.1, 1.0, 0.0, 1.0,  //
      0.0, 0.0, 0.0, 1.0, 1.0;
  CHECK(farthest_columns(points, 3, 0.01) == std::vector<Eigen::Index>{0, 4, 2});
  CHECK(farthest_columns(points, 9, 0.2).size() == 4);
  CHECK(farthest_columns(points, 9, 0.01).size() == 5);
  CHECK(farthest_columns(Eigen::MatrixXd(2, 0), 3, 0.01).empty());
}
