// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/separability.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/diagnosis/small_models.hpp"
#include "tests/support/binomial.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// Two fingerprints of norm `norm` with correlation rho on the first two of p statistics.
LinearModel two_effects(double norm, double rho) {
  LinearModel model;
  model.statistics = {{"a", "0"}, {"a", "1"}};
  model.jacobian.resize(2, 0);
  model.fingerprints.resize(2, 2);
  model.fingerprints << 1.0, rho, 0.0, std::sqrt(1.0 - rho * rho);
  model.fingerprints *= norm;
  return model;
}

}  // namespace

TEST_CASE("Separability: probability of the right order is exact", "[calibrate][diagnosis]") {
  const double rho = GENERATE(-0.7, 0.0, 0.5, 0.95);
  const double lambda = GENERATE(0.5, 6.0, 30.0);
  std::mt19937_64 rng(2);
  int right = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double a = standard_normal(rng);
    const double b = standard_normal(rng);
    const double zi = std::sqrt(lambda) + a;
    const double zj = rho * std::sqrt(lambda) + rho * a + std::sqrt(1.0 - rho * rho) * b;
    right += std::abs(zi) > std::abs(zj) ? 1 : 0;
  }
  REQUIRE(binomial_tail(right, n, ordering_probability(lambda, rho)) > 1e-4);
}

TEST_CASE("Separability: 95 % needs lambda (1 - |rho|) of 5.4", "[calibrate][diagnosis]") {
  // 11, 27, 54, 108 and 541 as published; the other term of the probability is below 0.5 % there.
  const double rhos[] = {0.5, 0.8, 0.9, 0.95, 0.99};
  const double lambdas[] = {11.0, 27.0, 54.0, 108.0, 541.0};
  for (int i = 0; i < 5; ++i) {
    REQUIRE_THAT(ordering_probability(lambdas[i], rhos[i]), WithinAbs(0.95, 0.003));
    REQUIRE(is_separable(1.02 * lambdas[i], -rhos[i]));
    REQUIRE_FALSE(is_separable(0.98 * lambdas[i], rhos[i]));
  }
}

TEST_CASE("Separability: the look-alike map is the correlation of what is left",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(3);
  LinearModel model = random_model(9, 2, 3, rng);
  // A shift along the parameters changes nothing.
  model.fingerprints.col(1) =
      -2.0 * model.fingerprints.col(0) + model.jacobian * Eigen::Vector2d(3.0, 1.0);
  model.fingerprints.col(2) = model.jacobian.col(0);
  const ProjectedEvidence e = project(model, Eigen::VectorXd::Zero(9), block_covariance(9, rng));
  const Eigen::MatrixXd rho = look_alike_map(e);
  REQUIRE_THAT(rho(0, 1), WithinAbs(-1.0, 1e-12));
  REQUIRE(rho(0, 2) == 0.0);
  REQUIRE(rho(2, 2) == 1.0);
}

TEST_CASE("Separability: effects that cannot be told apart form groups", "[calibrate][diagnosis]") {
  Eigen::MatrixXd rho = Eigen::MatrixXd::Identity(4, 4);
  rho(0, 2) = rho(2, 0) = 0.9;    // needs lambda 54
  rho(1, 2) = rho(2, 1) = -0.95;  // needs lambda 108
  const std::vector<std::size_t> all = {3, 2, 1, 0};
  using Groups = std::vector<std::vector<std::size_t>>;
  REQUIRE(look_alike_groups(rho, Eigen::Vector4d::Constant(60.0), all) == Groups{{0}, {1, 2}, {3}});
  REQUIRE(look_alike_groups(rho, Eigen::Vector4d::Constant(20.0), all) == Groups{{0, 1, 2}, {3}});
  REQUIRE(look_alike_groups(rho, Eigen::Vector4d::Constant(200.0), all) ==
          Groups{{0}, {1}, {2}, {3}});
  // One weak member is enough.
  REQUIRE(look_alike_groups(rho, Eigen::Vector4d(200.0, 200.0, 200.0, 1.0), all) ==
          Groups{{0, 1, 2, 3}});
}

TEST_CASE("Separability: the next experiment is the one that parts the contenders, per cost",
          "[calibrate][diagnosis]") {
  const LinearModel now = two_effects(3.0, 0.95);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  const auto experiment = [&](const std::string& name, double first, double second, double cost) {
    PossibleExperiment e{name, {}, one, cost};
    e.model.statistics = {{name, "x"}};
    e.model.jacobian.resize(1, 0);
    e.model.fingerprints.resize(1, 2);
    e.model.fingerprints << first, second;
    return e;
  };
  // "same" moves both alike, "apart" one only, "dear" does so at ten times the cost.
  const auto advice =
      next_experiments(now, Eigen::MatrixXd::Identity(2, 2), {0, 1}, Eigen::Vector2d::Ones(),
                       {experiment("same", 3.0, 3.0, 1.0), experiment("dear", 0.0, 4.0, 10.0),
                        experiment("apart", 0.0, 4.0, 1.0)});
  REQUIRE(advice.size() == 3);
  REQUIRE(advice[0].name == "apart");
  REQUIRE(advice[1].name == "dear");
  // Before: 9 (1 - 0.95) both ways. After: norms 3 and 5, product 0.95 * 9.
  REQUIRE_THAT(advice[0].separation_before, WithinRel(0.45, 1e-12));
  REQUIRE_THAT(advice[0].separation_after, WithinRel(9.0 * (1.0 - 8.55 / 15.0), 1e-12));
  REQUIRE_THAT(advice[0].ordering_after, WithinRel(ordering_probability(9.0, 0.57), 1e-12));
  REQUIRE_THAT(advice[1].gain_per_cost, WithinRel(0.1 * advice[0].gain_per_cost, 1e-12));
  REQUIRE(advice[2].separation_after <= advice[2].separation_before + 1e-12);
  REQUIRE(next_experiments(now, Eigen::MatrixXd::Identity(2, 2), {0}, Eigen::Vector2d::Ones(),
                           {experiment("apart", 0.0, 4.0, 1.0)})
              .empty());
}

TEST_CASE("Separability: where no single experiment shows both, the mean decides",
          "[calibrate][diagnosis]") {
  LinearModel blind = two_effects(1.0, 0.5);
  blind.fingerprints.setZero();
  PossibleExperiment nothing{"nothing", {}, Eigen::MatrixXd::Identity(1, 1), 1.0};
  nothing.model.statistics = {{"x", "x"}};
  nothing.model.jacobian.resize(1, 0);
  nothing.model.fingerprints = Eigen::MatrixXd::Zero(1, 2);
  PossibleExperiment one = nothing;
  one.name = "one";
  one.model.fingerprints(0, 0) = 1.0;
  const auto advice = next_experiments(blind, Eigen::MatrixXd::Identity(2, 2), {0, 1},
                                       Eigen::Vector2d::Ones(), {nothing, one});
  REQUIRE(advice[0].name == "one");
  REQUIRE(advice[0].gain_per_cost == 0.0);
  // Effect 0 true: lambda 1, rho 0; effect 1 true: lambda 0.
  REQUIRE_THAT(advice[0].mean_gain_per_cost, WithinRel(0.5, 1e-12));
}
