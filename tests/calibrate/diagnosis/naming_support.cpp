// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/naming_support.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/diagnosis/small_models.hpp"
#include "tests/support/binomial.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// Four experiments of three statistics, V = 1, no parameter; effect 0 moves each statistic of
// experiment e by size[e].
LinearModel model_with(const Eigen::Vector4d& size) {
  LinearModel model;
  model.jacobian.resize(12, 0);
  model.fingerprints.resize(12, 1);
  for (Eigen::Index i = 0; i < 12; ++i) {
    model.statistics.push_back({std::string(1, static_cast<char>('a' + i / 3)), std::to_string(i)});
    model.fingerprints(i, 0) = size[i / 3];
  }
  return model;
}

int support(const LinearModel& model, const Eigen::VectorXd& residual) {
  const Eigen::MatrixXd v = Eigen::MatrixXd::Identity(12, 12);
  const std::vector<ProjectedEvidence> soils = {project(model, residual, v)};
  return num_supporting_experiments(soils, 0, EffectSign::positive, {1.0});
}

}  // namespace

TEST_CASE("Support: it takes as many wrong experiments as speak for an effect",
          "[calibrate][diagnosis]") {
  const LinearModel even = model_with(Eigen::Vector4d::Constant(2.0));
  // z of one experiment: 2 sqrt(3) = 3.5; all four must be struck out.
  REQUIRE(support(even, even.fingerprints.col(0)) == 4);
  const LinearModel one_rig = model_with(Eigen::Vector4d(3.0, 0.0, 0.0, 0.0));
  REQUIRE(support(one_rig, one_rig.fingerprints.col(0)) == 1);
  // The others move a little: 0.4 sqrt(9) = 1.2 is no evidence.
  const LinearModel weak = model_with(Eigen::Vector4d(3.0, 0.4, 0.4, 0.4));
  REQUIRE(support(weak, weak.fingerprints.col(0)) == 1);
  REQUIRE(support(even, -even.fingerprints.col(0)) == 0);
  REQUIRE(support(even, Eigen::VectorXd::Zero(12)) == 0);
}

TEST_CASE("Support: an error of one rig is one experiment's word, however it spreads",
          "[calibrate][diagnosis]") {
  // All experiments share a parameter, so an error of experiment a pulls the fit of all others.
  LinearModel model = model_with(Eigen::Vector4d(2.0, 0.7, 0.0, 0.0));
  model.jacobian = Eigen::MatrixXd::Ones(12, 1);
  Eigen::VectorXd error = Eigen::VectorXd::Zero(12);
  error.head(3).setConstant(4.0);
  REQUIRE(support(model, error) == 1);
}

TEST_CASE("Support: the same rig in another soil is not another experiment",
          "[calibrate][diagnosis]") {
  const LinearModel model = model_with(Eigen::Vector4d(3.0, 0.0, 0.0, 0.0));
  const ProjectedEvidence e =
      project(model, model.fingerprints.col(0), Eigen::MatrixXd::Identity(12, 12));
  REQUIRE(num_supporting_experiments(std::vector{e, e, e}, 0, EffectSign::positive,
                                     {1.0, 1.0, 1.0}) == 1);
}

TEST_CASE("Size: least squares of all named effects together", "[calibrate][diagnosis]") {
  std::mt19937_64 rng(4);
  const LinearModel model = random_model(12, 2, 3, rng);
  const Eigen::MatrixXd v = block_covariance(12, rng);
  const Eigen::VectorXd r =
      model.fingerprints * Eigen::Vector3d(3.0, 0.0, 2.0) + model.jacobian * Eigen::Vector2d(1, -1);
  const std::vector<ProjectedEvidence> soils = {project(model, r, v)};
  const auto sizes = effect_sizes(soils, unit_candidates(3), {0, 2});
  REQUIRE_THAT(sizes[0][0].value, WithinRel(3.0, 1e-10));
  REQUIRE_THAT(sizes[0][1].value, WithinRel(2.0, 1e-10));
  const Eigen::MatrixXd f = soils[0].fingerprints(Eigen::all, std::vector<Eigen::Index>{0, 2});
  const Eigen::MatrixXd c = (f.transpose() * f).inverse();
  REQUIRE_THAT(sizes[0][0].standard_error, WithinRel(std::sqrt(c(0, 0)), 1e-10));
  // 1.697 = t(0.95, 30).
  REQUIRE_THAT(sizes[0][0].hi90, WithinAbs(3.0 + 1.697 * std::sqrt(c(0, 0)), 1e-3));
}

TEST_CASE("Size: the interval holds the truth as often as it says", "[calibrate][diagnosis]") {
  std::mt19937_64 rng(5);
  const LinearModel model = random_model(15, 3, 2, rng);
  const Eigen::MatrixXd v = block_covariance(15, rng);
  const Eigen::MatrixXd root = v.llt().matrixL();
  int inside = 0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const Eigen::VectorXd r = root * normal_matrix(15, 1, rng) + 5.0 * model.fingerprints.col(0);
    const EffectSize s =
        effect_sizes(std::vector{project(model, r, v)}, unit_candidates(2), {0})[0][0];
    inside += s.lo90 <= 5.0 && 5.0 <= s.hi90 ? 1 : 0;
  }
  // At least 90 %; t with 30 degrees and the scale max(1, ...) widen it where V is known: 93.5 % is
  // what P(|N| <= 1.697 E sqrt(max(1, chi2_11 / 11))) gives, bounded by 96 %.
  REQUIRE(inside > 0.89 * n);
  REQUIRE(inside < 0.96 * n);
}

TEST_CASE("Size: a common size is estimated from all soils", "[calibrate][diagnosis]") {
  std::mt19937_64 rng(6);
  const LinearModel model = random_model(9, 1, 1, rng);
  const Eigen::MatrixXd v = Eigen::MatrixXd::Identity(9, 9);
  const Eigen::VectorXd f = model.fingerprints.col(0);
  const std::vector<ProjectedEvidence> soils = {project(model, 2.0 * f, v),
                                                project(model, 4.0 * f, v)};
  auto candidates = unit_candidates(1);
  REQUIRE_THAT(effect_sizes(soils, candidates, {0})[1][0].value, WithinRel(4.0, 1e-12));
  candidates[0].common_size = true;
  REQUIRE_THAT(effect_sizes(soils, candidates, {0})[0][0].value, WithinRel(3.0, 1e-12));
  REQUIRE_THAT(effect_sizes(soils, candidates, {0})[1][0].value, WithinRel(3.0, 1e-12));
}

TEST_CASE("Stability: a strong effect leads in all resamples, none in a coin toss",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(7);
  SoilEvidence soil;
  soil.model = random_model(12, 2, 4, rng);
  soil.candidates = unit_candidates(4);
  soil.noise.replicate_variances = Eigen::VectorXd::Ones(12);
  soil.noise.packing_variances = Eigen::VectorXd::Constant(12, 0.2);
  for (Eigen::Index i = 0; i < 12; i += 3)
    soil.samples.push_back(
        {{i, i + 1, i + 2}, Eigen::MatrixXd::Zero(5, 3), Eigen::MatrixXd::Zero(8, 3)});
  soil.samples = drawn_samples(soil.samples, soil.noise, rng);
  SoilEvidence strong = soil;
  for (TestSamples& test : strong.samples)
    test.replicates.rowwise() += 4.0 * soil.model.fingerprints(test.statistics, 1).transpose();
  const NamingStability sure = naming_stability(std::vector{strong}, 50, 1);
  REQUIRE(sure.leading[1] == 1.0);
  const NamingStability doubtful = naming_stability(std::vector{soil}, 50, 1);
  REQUIRE(doubtful.leading.maxCoeff() < 0.8);
  REQUIRE_THAT(doubtful.leading.sum() + doubtful.none + doubtful.other, WithinRel(1.0, 1e-12));
  // The same seed, the same answer.
  REQUIRE(naming_stability(std::vector{soil}, 50, 1).none == doubtful.none);
}
