// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/posterior.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "calibrate/diagnosis/thresholds.hpp"
#include "tests/calibrate/diagnosis/small_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;
using namespace tilth::diagnosis_thresholds;

namespace {

// Evidence of independent fingerprints f_k along the axes of u.
EvidenceTerms axis_terms(const Eigen::VectorXd& u, const Eigen::VectorXd& norms) {
  LinearModel model;
  for (Eigen::Index i = 0; i < u.size(); ++i) model.statistics.push_back({"a", std::to_string(i)});
  model.jacobian.resize(u.size(), 0);
  model.fingerprints = Eigen::MatrixXd::Zero(u.size(), norms.size());
  model.fingerprints.topRows(norms.size()) = norms.asDiagonal();
  const Eigen::MatrixXd v = Eigen::MatrixXd::Identity(u.size(), u.size());
  return evidence_terms(project(model, u, v), unit_candidates(norms.size(), EffectSign::free));
}

double student(const Eigen::VectorXd& u, const Eigen::MatrixXd& scale) {
  const auto nu = static_cast<double>(u.size());
  return -0.5 * std::log(scale.determinant()) -
         0.5 * (evidence_freedom + nu) *
             std::log(1.0 + u.dot(scale.inverse() * u) / evidence_freedom);
}

}  // namespace

TEST_CASE("Posterior: evidence of free effects is a multivariate t with their covariance added",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(1);
  const LinearModel model = random_model(9, 2, 3, rng);
  auto candidates = unit_candidates(3, EffectSign::free);
  candidates[1].typical = 0.4;
  const ProjectedEvidence e = project(model, normal_matrix(9, 1, rng), block_covariance(9, rng));
  const EvidenceTerms terms = evidence_terms(e, candidates);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(e.nu(), e.nu());
  const Eigen::VectorXd f1 = 0.4 * e.fingerprints.col(1);
  const Eigen::VectorXd f2 = e.fingerprints.col(2);
  // Woodbury: u'(I + D D')^-1 u = u'u - b'(I + G)^-1 b, det(I + D D') = det(I + G).
  REQUIRE_THAT(log_evidence(terms, {}, candidates), WithinRel(student(e.u, one), 1e-12));
  REQUIRE_THAT(log_evidence(terms, {{1}}, candidates),
               WithinRel(student(e.u, one + f1 * f1.transpose()), 1e-12));
  REQUIRE_THAT(log_evidence(terms, {{1, 2}}, candidates),
               WithinRel(student(e.u, one + f1 * f1.transpose() + f2 * f2.transpose()), 1e-12));
  double mean = 0.0;
  for (const double g : {0.3, 0.7, 1.5, 3.0, 6.0, 12.0})
    mean += std::exp(student(e.u, (1.0 + g) * one)) / 6.0;
  REQUIRE_THAT(log_evidence(terms, {{}, true}, candidates), WithinRel(std::log(mean), 1e-12));
}

TEST_CASE("Posterior: the sign of a positive effect is worth up to a factor of two",
          "[calibrate][diagnosis]") {
  const auto ratio = [](double u) {
    const EvidenceTerms terms =
        axis_terms(Eigen::VectorXd::Unit(5, 0) * u, Eigen::VectorXd::Constant(1, 5.0));
    return std::exp(log_evidence(terms, {{0}}, unit_candidates(1)) -
                    log_evidence(terms, {{0}}, unit_candidates(1, EffectSign::free)));
  };
  REQUIRE_THAT(ratio(6.0), WithinRel(2.0, 1e-6));
  REQUIRE_THAT(ratio(0.0), WithinRel(1.0, 1e-12));
  REQUIRE(ratio(-6.0) < 1e-6);
  // Two orthogonal effects, no residual: each sign is even.
  const EvidenceTerms two = axis_terms(Eigen::VectorXd::Zero(5), Eigen::Vector2d(3.0, 4.0));
  REQUIRE_THAT(log_evidence(two, {{0, 1}}, unit_candidates(2)),
               WithinRel(log_evidence(two, {{0, 1}}, unit_candidates(2, EffectSign::free)), 1e-12));
}

TEST_CASE("Posterior: evidence with a half-normal size, against the integral over the size",
          "[calibrate][diagnosis]") {
  // With normal noise the evidence is int_0^inf 2 phi(a) exp(-|u - a f|^2 / 2) da. The t density
  // with 30 degrees of freedom differs; compared is the ratio to "nothing" at small Q, where the t
  // exponent is (df + nu) / (2 df) times the normal one: 20 % of a logarithm of at most 1.
  const double f = 2.0;
  for (const double u : {-1.0, 0.0, 1.0, 1.5}) {
    const EvidenceTerms terms =
        axis_terms(Eigen::VectorXd::Unit(4, 0) * u, Eigen::VectorXd::Constant(1, f));
    double integral = 0.0;
    const double h = 1e-4;
    for (int i = 0; i < 80000; ++i) {
      const double a = h * (i + 0.5);
      integral += h * 2.0 * std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi) *
                  std::exp(-0.5 * (u - a * f) * (u - a * f) + 0.5 * u * u);
    }
    const double found = log_evidence(terms, {{0}}, unit_candidates(1)) -
                         log_evidence(terms, {}, unit_candidates(1));
    REQUIRE_THAT(found, WithinAbs(std::log(integral), 0.2));
  }
}

TEST_CASE("Posterior: without data it is the prior", "[calibrate][diagnosis]") {
  // Fingerprints of 1e-9: measurable, but they move nothing; "other" is not the prior, since the
  // absence of any discrepancy speaks against one.
  const EvidenceTerms terms = axis_terms(Eigen::VectorXd::Zero(3), Eigen::Vector3d::Constant(1e-9));
  const Posterior p = posterior(std::vector{terms}, unit_candidates(3));
  REQUIRE(p.explanations.size() == 1 + 3 + 3 + 1);
  REQUIRE_THAT(p.none / (p.none + 3.0 * p.explanations[1].probability), WithinRel(0.5, 1e-6));
  double sum = 0.0;
  for (const Explanation& e : p.explanations) sum += e.probability;
  REQUIRE_THAT(sum, WithinRel(1.0, 1e-12));
  // inclusion = single + two pairs: 0.4 / 3 + 2 * 0.1 / 3 beside 0.4 of nothing.
  REQUIRE_THAT(p.inclusion[0] / p.none, WithinRel((0.4 / 3.0 + 0.2 / 3.0) / 0.4, 1e-6));
}

TEST_CASE("Posterior: effects that are measurable nowhere are no explanation",
          "[calibrate][diagnosis]") {
  const EvidenceTerms terms = axis_terms(Eigen::VectorXd::Ones(3), Eigen::Vector2d(0.0, 2.0));
  const Posterior p = posterior(std::vector{terms}, unit_candidates(2));
  REQUIRE(p.explanations.size() == 3);  // nothing, other, the second effect
  REQUIRE(p.inclusion[0] == 0.0);
  const EvidenceTerms none = axis_terms(Eigen::VectorXd::Ones(3), Eigen::Vector2d(0.0, 0.0));
  REQUIRE(posterior(std::vector{none}, unit_candidates(2)).explanations.size() == 2);
}

TEST_CASE("Posterior: evidence of several soils multiplies, and a common size is one number",
          "[calibrate][diagnosis]") {
  auto candidates = unit_candidates(2, EffectSign::free);
  const EvidenceTerms up = axis_terms(Eigen::VectorXd::Unit(4, 0) * 2.5, Eigen::Vector2d(4.0, 1.0));
  const EvidenceTerms down =
      axis_terms(Eigen::VectorXd::Unit(4, 0) * -2.5, Eigen::Vector2d(4.0, 1.0));
  const std::vector<EvidenceTerms> alike = {up, up, up};
  const std::vector<EvidenceTerms> unlike = {up, down};
  const auto odds = [&](const std::vector<EvidenceTerms>& soils) {
    const Posterior p = posterior(soils, candidates);
    double single = 0.0;
    for (const Explanation& e : p.explanations)
      if (e.effects == std::vector<std::size_t>{0}) single = e.probability;
    return single / p.none;
  };
  const double one = odds({up}) / (0.2 / 0.4);
  REQUIRE_THAT(odds(alike) / (0.2 / 0.4), WithinRel(one * one * one, 1e-9));
  // Own sizes do not care for the sign, a common one does: two soils that disagree refute it.
  REQUIRE_THAT(odds(unlike) / (0.2 / 0.4), WithinRel(one * one, 1e-9));
  candidates[0].common_size = true;
  REQUIRE(odds(unlike) < 0.2);
  // Three soils that agree say more of one size than of three: two priors of a size less to pay.
  REQUIRE(odds(alike) > 2.0 * one * one * one * (0.2 / 0.4));
}

TEST_CASE("Posterior: the credible set is the smallest that covers, a pair by either effect",
          "[calibrate][diagnosis]") {
  Posterior p;
  p.inclusion = Eigen::Vector3d(0.75, 0.5, 0.05);
  p.none = 0.1;
  p.other = 0.02;
  p.explanations = {{{0, 1}, false, 0.0, 0.42}, {{0}, false, 0.0, 0.33}, {{}, false, 0.0, 0.10},
                    {{1}, false, 0.0, 0.08},    {{2}, false, 0.0, 0.05}, {{}, true, 0.0, 0.02}};
  const CredibleSet set = credible_set(p, 0.95);
  // Effect 0 covers 0.75, then nothing 0.10, effect 1 0.08, effect 2 0.05: 0.98.
  REQUIRE(set.effects == std::vector<std::size_t>{0, 1, 2});
  REQUIRE(set.none);
  REQUIRE_FALSE(set.other);
  REQUIRE_THAT(set.probability, WithinRel(0.98, 1e-12));
  REQUIRE(set.size() == 4);
  REQUIRE(credible_set(p, 0.7).effects == std::vector<std::size_t>{0});
}
