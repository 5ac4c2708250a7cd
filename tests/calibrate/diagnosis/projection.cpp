// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/projection.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>

#include "calibrate/diagnosis/effect_scores.hpp"
#include "calibrate/diagnosis/gap_detection.hpp"
#include "tests/calibrate/diagnosis/small_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// Least chi-square over parameters and the sizes of some effects, with priors, by normal equations.
double least_chi_square(const LinearModel& model, const Eigen::VectorXd& residual,
                        const Eigen::MatrixXd& covariance,
                        const std::vector<Eigen::Index>& effects) {
  const Eigen::Index q = model.jacobian.cols();
  Eigen::MatrixXd design(residual.size(), q + static_cast<Eigen::Index>(effects.size()));
  design << model.jacobian, model.fingerprints(Eigen::all, effects);
  const Eigen::MatrixXd weight = covariance.inverse();
  Eigen::MatrixXd information = design.transpose() * weight * design;
  Eigen::VectorXd right = design.transpose() * weight * residual;
  double constant = residual.dot(weight * residual);
  for (Eigen::Index j = 0; j < model.prior_precision.size(); ++j) {
    information(j, j) += model.prior_precision[j];
    right[j] += model.prior_precision[j] * model.prior_offset[j];
    constant += model.prior_precision[j] * model.prior_offset[j] * model.prior_offset[j];
  }
  return constant - right.dot(information.inverse() * right);
}

}  // namespace

TEST_CASE("Projection: score, modification index and expected change are those of a refit",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(1);
  LinearModel model = random_model(12, 3, 4, rng);
  const bool with_priors = GENERATE(false, true);
  if (with_priors) {
    model.prior_precision = Eigen::Vector3d(0.5, 0.0, 2.0);
    model.prior_offset = Eigen::Vector3d(0.3, 0.0, -0.7);
  }
  const Eigen::MatrixXd v = block_covariance(12, rng);
  const Eigen::VectorXd r = normal_matrix(12, 1, rng);
  const ProjectedEvidence e = project(model, r, v);
  REQUIRE(e.nu() == (with_priors ? 11 : 9));
  const double baseline = least_chi_square(model, r, v, {});
  // 1e-10: normal equations of well-scaled random numbers.
  REQUIRE_THAT(e.u.squaredNorm(), WithinRel(baseline, 1e-10));
  const auto scores = effect_scores(e, unit_candidates(4, EffectSign::free));
  for (Eigen::Index k = 0; k < 4; ++k) {
    const EffectScore& s = scores[static_cast<std::size_t>(k)];
    REQUIRE_THAT(s.modification_index,
                 WithinRel(baseline - least_chi_square(model, r, v, {k}), 1e-8));
    REQUIRE_THAT(s.expected_change, WithinRel(s.z * s.standard_error, 1e-12));
    // Taking the estimated effect out of the data leaves nothing of it.
    const Eigen::VectorXd rest = r - s.expected_change * model.fingerprints.col(k);
    REQUIRE_THAT(signed_scores(project(model, rest, v))[k], WithinAbs(0.0, 1e-10));
  }
  REQUIRE_THAT(gap_beyond(e, {0, 2}).chi_square,
               WithinRel(least_chi_square(model, r, v, {0, 2}), 1e-10));
  REQUIRE(gap_beyond(e, {0, 2}).nu == static_cast<double>(e.nu() - 2));
}

TEST_CASE("Projection: a fingerprint that parameters imitate keeps nothing and is not measurable",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(2);
  LinearModel model = random_model(9, 2, 3, rng);
  model.fingerprints.col(0) = model.jacobian * Eigen::Vector2d(1.0, -2.0);
  model.fingerprints.col(1).setZero();
  const ProjectedEvidence e =
      project(model, normal_matrix(9, 1, rng), Eigen::MatrixXd::Identity(9, 9));
  REQUIRE_THAT(e.kept[0], WithinAbs(0.0, 1e-25));
  REQUIRE_FALSE(e.is_measurable(0));
  REQUIRE(e.kept[1] == 0.0);
  REQUIRE_FALSE(e.is_measurable(1));
  REQUIRE(e.is_measurable(2));
  REQUIRE(signed_scores(e)[0] == 0.0);
  REQUIRE(effect_scores(e, unit_candidates(3))[0].decision == EffectDecision::not_measurable);
}

TEST_CASE("Projection: expected norm of a fingerprint that is packing noise only",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(3);
  LinearModel model = random_model(12, 2, 1, rng);
  const Eigen::MatrixXd exact_jacobian = model.jacobian;
  const Eigen::MatrixXd v = block_covariance(12, rng);
  // The effect looks like 3 times the first parameter: noise of the jacobian counts three times.
  model.fingerprints = 3.0 * exact_jacobian.col(0);
  model.fingerprint_variances = Eigen::VectorXd::LinSpaced(12, 1e-6, 9e-6);
  model.jacobian_variances = Eigen::MatrixXd::Zero(12, 2);
  model.jacobian_variances.col(0).setConstant(1e-6);
  const double expected = project(model, Eigen::VectorXd::Zero(12), v).noise_norms[0];
  double sum = 0.0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    LinearModel noisy = model;
    noisy.fingerprints.col(0) += model.fingerprint_variances.col(0).cwiseSqrt().cwiseProduct(
        normal_matrix(12, 1, rng).col(0));
    noisy.jacobian.col(0) += 1e-3 * normal_matrix(12, 1, rng).col(0);
    sum += project(noisy, Eigen::VectorXd::Zero(12), v).fingerprints.col(0).squaredNorm();
  }
  // 4 %: a sum of 10 squares of unequal weights, whose relative sd is near 0.6, over sqrt(4000).
  REQUIRE_THAT(sum / n, WithinRel(expected, 0.04));
}

TEST_CASE("Projection: parameters without influence cost no degree of freedom",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(4);
  LinearModel model = random_model(6, 3, 1, rng);
  model.jacobian.col(2) = model.jacobian.col(0) - model.jacobian.col(1);
  REQUIRE(project(model, Eigen::VectorXd::Ones(6), Eigen::MatrixXd::Identity(6, 6)).nu() == 4);
  model.jacobian.resize(6, 0);
  REQUIRE(project(model, Eigen::VectorXd::Ones(6), Eigen::MatrixXd::Identity(6, 6)).nu() == 6);
}

TEST_CASE("Projection: shapes, numbers that are not finite and an indefinite V are refused",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(5);
  const LinearModel model = random_model(6, 2, 1, rng);
  const Eigen::MatrixXd v = Eigen::MatrixXd::Identity(6, 6);
  REQUIRE_THROWS_AS(project(model, Eigen::VectorXd::Ones(5), v), std::invalid_argument);
  Eigen::VectorXd r = Eigen::VectorXd::Ones(6);
  REQUIRE_THROWS_AS(project(model, r, -v), std::invalid_argument);
  LinearModel unequal = model;
  unequal.prior_precision = Eigen::VectorXd::Ones(3);
  REQUIRE_THROWS_AS(project(unequal, r, v), std::invalid_argument);
  r[3] = std::numeric_limits<double>::quiet_NaN();
  REQUIRE_THROWS_AS(project(model, r, v), std::invalid_argument);
}
