// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/noise.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <stdexcept>

#include "calibrate/moderated_variances.hpp"
#include "tests/calibrate/diagnosis/small_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

NoisePriors unit_priors(Eigen::Index p) {
  NoisePriors priors;
  priors.replicate_variances = priors.packing_variances = Eigen::VectorXd::Ones(p);
  return priors;
}

}  // namespace

TEST_CASE("Noise: a variance is the mean of prior and sample, weighted by degrees of freedom",
          "[calibrate][diagnosis]") {
  Eigen::MatrixXd samples(3, 2);
  samples << 1.0, 5.0, 2.0, 5.0, 3.0, 5.0;  // variances 1 and 0 with 2 degrees of freedom
  const Eigen::VectorXd v =
      moderated_variances(samples.transpose(), Eigen::Vector2d(4.0, 4.0), 8.0);
  REQUIRE_THAT(v[0], WithinRel((8.0 * 4.0 + 2.0 * 1.0) / 10.0, 1e-14));
  // Specimens that agree by chance do not make a statistic exact.
  REQUIRE_THAT(v[1], WithinRel(3.2, 1e-14));
  REQUIRE_THAT(moderated_variances(samples.transpose(), Eigen::Vector2d(4.0, 4.0), 0.0)[0],
               WithinRel(1.0, 1e-14));
}

TEST_CASE("Noise: one correlation for the whole test, measured where there is data",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(1);
  const Eigen::MatrixXd independent = normal_matrix(4000, 3, rng);
  Eigen::MatrixXd samples = independent;
  samples.col(1) = 0.6 * independent.col(0) + 0.8 * independent.col(1);
  samples.col(2) = 0.6 * independent.col(0) + 0.8 * independent.col(2);
  const Eigen::MatrixXd c = moderated_covariance(samples, Eigen::Vector3d::Ones(), 8.0, 0.3);
  // Mean of 0.6, 0.6, 0.36 = 0.52; standard error of each 0.016.
  const double r01 = c(0, 1) / std::sqrt(c(0, 0) * c(1, 1));
  REQUIRE_THAT(r01, WithinAbs(0.52, 0.04));
  REQUIRE_THAT(c(1, 2) / std::sqrt(c(1, 1) * c(2, 2)), WithinRel(r01, 1e-12));
  // One specimen says nothing: the prior.
  const Eigen::MatrixXd one =
      moderated_covariance(samples.topRows(1), Eigen::Vector3d(1, 4, 9), 8.0, 0.3);
  REQUIRE_THAT(one(0, 2), WithinRel(0.9, 1e-13));
}

TEST_CASE("Noise: measured anticorrelation does not make statistics cancel",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(2);
  Eigen::MatrixXd samples = normal_matrix(400, 2, rng);
  samples.col(1) = -samples.col(0);
  const Eigen::MatrixXd c = moderated_covariance(samples, Eigen::Vector2d::Ones(), 8.0, 0.3);
  REQUIRE(c(0, 1) == 0.0);
  samples.col(1) = samples.col(0);
  const Eigen::MatrixXd d = moderated_covariance(samples, Eigen::Vector2d::Ones(), 8.0, 0.3);
  REQUIRE(d.llt().info() == Eigen::Success);
  REQUIRE_THAT(d(0, 1), WithinRel(0.95 * std::sqrt(d(0, 0) * d(1, 1)), 1e-12));
}

TEST_CASE("Noise: V has the means' variances in blocks and nothing between tests",
          "[calibrate][diagnosis]") {
  NoisePriors priors = unit_priors(3);
  priors.packing_variances *= 4.0;
  priors.additional_variances = Eigen::Vector3d(0.0, 0.5, 0.0);
  priors.freedom = 1e12;  // the prior alone
  const std::vector<TestSamples> tests = {
      {{0, 2}, Eigen::MatrixXd::Zero(5, 2), Eigen::MatrixXd::Zero(8, 2)},
      {{1}, Eigen::MatrixXd::Zero(2, 1), Eigen::MatrixXd::Zero(4, 1)}};
  Eigen::Matrix3d exact;
  // 1/5 + 4/8 = 0.7; 1/2 + 4/4 + 0.5 = 2; correlation 0.3 within the first test. 1e-9: 1 / 1e12.
  exact << 0.7, 0.0, 0.21, 0.0, 2.0, 0.0, 0.21, 0.0, 0.7;
  REQUIRE((noise_covariance(tests, priors).total() - exact).norm() < 1e-9);
}

TEST_CASE("Noise: what makes no sense is refused", "[calibrate][diagnosis]") {
  const NoisePriors priors = unit_priors(2);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Zero(1, 1);
  REQUIRE_THROWS_AS(noise_covariance({{{0}, one, one}}, priors), std::invalid_argument);
  REQUIRE_THROWS_AS(noise_covariance({{{0}, one, one}, {{0}, one, one}}, priors),
                    std::invalid_argument);
  REQUIRE_THROWS_AS(noise_covariance({{{0}, one, one}, {{1}, Eigen::MatrixXd(0, 1), one}}, priors),
                    std::invalid_argument);
  NoisePriors zero = priors;
  zero.replicate_variances[1] = 0.0;
  REQUIRE_THROWS_AS(noise_covariance({{{0}, one, one}, {{1}, one, one}}, zero),
                    std::invalid_argument);
}

TEST_CASE("Noise: repetitions have the covariance they are drawn from", "[calibrate][diagnosis]") {
  NoisePriors priors = unit_priors(2);
  priors.freedom = 1e12;
  const std::vector<TestSamples> tests = {
      {{0, 1}, Eigen::MatrixXd::Zero(4, 2), Eigen::MatrixXd::Zero(2, 2)}};
  const Eigen::MatrixXd v = noise_covariance(tests, priors).total();
  std::mt19937_64 rng(5);
  const int n = 20000;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::VectorXd r = mean_difference(drawn_samples(tests, priors, rng), 2);
    sum += r * r.transpose();
  }
  // Four standard errors of a variance, sqrt(2 / n) of 0.75.
  REQUIRE((sum / n - v).cwiseAbs().maxCoeff() < 4.0 * 0.75 * std::sqrt(2.0 / n));
}

TEST_CASE("Noise: a resample is made of whole specimens", "[calibrate][diagnosis]") {
  TestSamples test{{0, 1}, Eigen::MatrixXd(4, 2), Eigen::MatrixXd(3, 2)};
  test.replicates << 1, 10, 2, 20, 3, 30, 4, 40;
  test.packings << 5, 50, 6, 60, 7, 70;
  std::mt19937_64 rng(1);
  bool changed = false;
  for (int i = 0; i < 20; ++i) {
    const TestSamples drawn = resampled({test}, rng).front();
    REQUIRE((drawn.replicates.col(1) - 10.0 * drawn.replicates.col(0)).norm() == 0.0);
    REQUIRE((drawn.packings.col(1) - 10.0 * drawn.packings.col(0)).norm() == 0.0);
    changed = changed || drawn.replicates != test.replicates;
  }
  REQUIRE(changed);
}
