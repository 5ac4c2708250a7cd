// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/gap_detection.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "tests/calibrate/diagnosis/small_models.hpp"
#include "tests/support/binomial.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// Ten tests of two statistics, four specimens and four packings each, nothing missing.
SoilEvidence null_soil(std::mt19937_64& rng) {
  SoilEvidence soil;
  soil.model = random_model(20, 3, 6, rng);
  soil.candidates = unit_candidates(6);
  soil.noise.replicate_variances = Eigen::VectorXd::Ones(20);
  soil.noise.packing_variances = Eigen::VectorXd::Constant(20, 0.5);
  for (Eigen::Index i = 0; i < 20; i += 2)
    soil.samples.push_back({{i, i + 1}, Eigen::MatrixXd::Zero(4, 2), Eigen::MatrixXd::Zero(4, 2)});
  NoisePriors truth = soil.noise;
  truth.freedom = 1e12;  // the zeros above are no measurement
  soil.samples = drawn_samples(soil.samples, truth, rng);
  return soil;
}

}  // namespace

TEST_CASE("Detection: bootstrap tails of a campaign without gap are uniform",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(1);
  const int n = 150;
  int small_x2 = 0;
  int small_max = 0;
  for (int i = 0; i < n; ++i) {
    const SoilEvidence soil = null_soil(rng);
    const NullRepetitions null = null_repetitions(soil, 99, 1000 + static_cast<std::uint64_t>(i));
    const ProjectedEvidence e = analysed(soil).projected;
    small_x2 += bootstrap_tail(null.chi_square, e.u.squaredNorm()) <= 0.2 ? 1 : 0;
    small_max += bootstrap_tail(null.largest_score, signed_scores(e).maxCoeff()) <= 0.2 ? 1 : 0;
  }
  // P = 0.2 exactly if V were drawn again from the truth; it is drawn from the moderated estimate,
  // so a little more is allowed than chance (1e-4).
  REQUIRE(binomial_tail(small_x2, n, 0.2) > 1e-4);
  REQUIRE(binomial_tail(small_max, n, 0.2) > 1e-4);
}

TEST_CASE("Detection: a gap of six standard deviations is beyond every repetition",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(2);
  SoilEvidence soil = null_soil(rng);
  for (TestSamples& test : soil.samples)
    test.replicates.rowwise() += 6.0 * soil.model.fingerprints(test.statistics, 2).transpose();
  const NullRepetitions null = null_repetitions(soil, 99, 5);
  const AnalysedSoil seen = analysed(soil);
  REQUIRE(bootstrap_tail(null.chi_square, seen.projected.u.squaredNorm()) == 0.01);
  REQUIRE(global_gap(seen.projected).tail_probability < 1e-6);
  // With the effect absorbed the rest is noise; 17 - 1 degrees of freedom.
  const GlobalGap rest = gap_beyond(seen.projected, {2});
  REQUIRE(rest.nu == 16.0);
  REQUIRE(rest.tail_probability > 1e-3);
  const ProjectedEvidence absorbed = with_absorbed(seen.projected, {2});
  REQUIRE_FALSE(absorbed.is_measurable(2));
  REQUIRE(absorbed.is_measurable(1));
  REQUIRE(absorbed.kept[1] <= seen.projected.kept[1]);
}

TEST_CASE("Detection: X2 is chi-square distributed when V is known", "[calibrate][diagnosis]") {
  std::mt19937_64 rng(3);
  const LinearModel model = random_model(12, 4, 1, rng);
  const Eigen::MatrixXd v = block_covariance(12, rng);
  const Eigen::MatrixXd root = v.llt().matrixL();
  int beyond = 0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const Eigen::VectorXd r = root * normal_matrix(12, 1, rng);
    beyond += chi_square_tail(project(model, r, v).u.squaredNorm(), 8.0) < 0.05 ? 1 : 0;
  }
  REQUIRE(binomial_tail(beyond, n, 0.05) > 1e-4);
}

TEST_CASE("Detection: the bootstrap tail is never zero", "[calibrate][diagnosis]") {
  const Eigen::VectorXd sample = Eigen::Vector3d(1.0, 2.0, 3.0);
  REQUIRE(bootstrap_tail(sample, 9.0) == 0.25);
  REQUIRE(bootstrap_tail(sample, 2.0) == 0.75);
  REQUIRE(bootstrap_tail(sample, 0.0) == 1.0);
}

TEST_CASE("Detection: decoys above an effect count as false discoveries",
          "[calibrate][diagnosis]") {
  const Eigen::Vector4d scores(5.0, 4.0, 1.0, 0.0);
  const Eigen::Vector4d decoys(4.5, 0.5, -1.0, -2.0);
  const Eigen::VectorXd share = false_discovery_shares(scores, decoys);
  // (1 + 0) / 1, (1 + 1) / 2 and (1 + 1) / 3: a single call is never better than one false one.
  REQUIRE_THAT(share[0], WithinAbs(1.0, 1e-15));
  REQUIRE_THAT(share[1], WithinAbs(1.0, 1e-15));
  REQUIRE_THAT(share[2], WithinRel(2.0 / 3.0, 1e-15));
  REQUIRE(false_discovery_shares(scores, Eigen::VectorXd()).minCoeff() == 1.0);
  // Eight decoys for four effects weigh half each.
  Eigen::VectorXd twice(8);
  twice << decoys, decoys;
  REQUIRE_THAT(false_discovery_shares(scores, twice)[2], WithinRel(0.5, 1e-15));
}
