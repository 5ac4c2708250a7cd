// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The Misra ladder: NIST Misra1a to 1d are the same data and one family of formulas. Asked from
// Misra1a, which effect is missing?
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "calibrate/diagnosis/separability.hpp"
#include "tests/calibrate/diagnosis/small_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

constexpr std::array<double, 14> xs = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                                       378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
constexpr std::array<double, 14> ys = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                                       44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
constexpr double b1 = 2.3894212918e+02;  // certified optimum of Misra1a
constexpr double b2 = 5.5015643181e-04;

enum Effect : Eigen::Index { family, linear, quadratic, logarithm, offset, decoy };

struct Expected {
  const char* id;
  EffectSign sign;
  double rss_drop, expected_change, f;
};

// Made from the certified optimum by an independent program; b1 (1 - (1 + g b2 x)^(-1/g)) for g.
constexpr std::array<Expected, 6> expected = {
    {{"family", EffectSign::positive, 0.111166366, 1.311030143, 91.358},
     {"linear", EffectSign::free, 0.1110772861, 0.141570389, 90.681},
     {"quadratic", EffectSign::free, 0.1109834613, 1.769807204e-05, 89.978},
     {"logarithm", EffectSign::free, 0.0767767896, 0.0732407566, 17.678},
     {"offset", EffectSign::free, 0.0706670640, 0.2780154150, 14.426},
     {"decoy", EffectSign::free, 0.0065820300, 0.0305573499, 0.614}}};

struct Ladder {
  LinearModel model;
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(14);
  std::vector<CandidateEffect> candidates;
};

Ladder ladder() {
  Ladder l;
  l.model.jacobian.resize(14, 2);
  l.model.fingerprints.resize(14, 6);
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double x = xs[i];
    const double z = b2 * x;
    const double decay = std::exp(-z);
    l.model.statistics.push_back({"absorption", std::to_string(i)});
    l.residual[row] = ys[i] - b1 * (1.0 - decay);
    l.model.jacobian.row(row) << 1.0 - decay, b1 * x * decay;
    // d/dg at g = 0: (1 + g z)^(-1/g) = exp(-z + g z^2 / 2 + ...).
    l.model.fingerprints.row(row) << -0.5 * b1 * z * z * decay, x, x * x, std::log(x), 1.0,
        std::sin(x / 50.0);
  }
  for (const Expected& e : expected)
    l.candidates.push_back({e.id, e.sign, e.expected_change, e.expected_change, false});
  return l;
}

}  // namespace

TEST_CASE("Misra ladder: predicted drops, sizes and F of six candidates",
          "[calibrate][diagnosis][misra]") {
  const Ladder l = ladder();
  const ProjectedEvidence e = project(l.model, l.residual, Eigen::MatrixXd::Identity(14, 14));
  // 1e-8: certified RSS to eleven digits, parameters rounded to eleven.
  REQUIRE_THAT(e.u.squaredNorm(), WithinRel(1.2455138894e-01, 1e-8));
  const auto scores = effect_scores(e, l.candidates);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double drop = std::pow(scores[k].z, 2);
    // 1e-7: nine to ten printed digits; 1e-4: three decimals of F.
    REQUIRE_THAT(drop, WithinRel(expected[k].rss_drop, 1e-7));
    REQUIRE_THAT(std::abs(scores[k].expected_change), WithinRel(expected[k].expected_change, 1e-7));
    REQUIRE_THAT(scale_free_f(drop, e.u.squaredNorm(), e.nu()), WithinRel(expected[k].f, 1e-3));
  }
}

TEST_CASE("Misra ladder: which candidates look alike", "[calibrate][diagnosis][misra]") {
  const Ladder l = ladder();
  const Eigen::MatrixXd rho =
      look_alike_map(project(l.model, l.residual, Eigen::MatrixXd::Identity(14, 14))).cwiseAbs();
  REQUIRE_THAT(rho(family, linear), WithinAbs(0.999707, 5e-7));
  REQUIRE_THAT(rho(family, quadratic), WithinAbs(0.999379, 5e-7));
  REQUIRE_THAT(rho(linear, quadratic), WithinAbs(0.999939, 5e-7));
  REQUIRE_THAT(rho(offset, logarithm), WithinAbs(0.998032, 5e-7));
  REQUIRE(rho.row(decoy).head(5).maxCoeff() <= 0.3975);
}

TEST_CASE("Misra ladder: the decoy is rejected, three are one class, and no name is printed",
          "[calibrate][diagnosis][misra]") {
  Ladder l = ladder();
  // Noise of the data: what is left after the best of the six, 0.12455 - 0.11117 on 11.
  const double sigma = std::sqrt((1.2455138894e-01 - 0.111166366) / 11.0);
  const EffectSign sign_of_family = GENERATE(EffectSign::positive, EffectSign::free);
  LinearModel scaled = l.model;
  scaled.jacobian /= sigma;
  scaled.fingerprints /= sigma;
  SoilEvidence soil = identity_soil(scaled, l.residual / sigma, l.candidates);
  soil.candidates[family].sign = sign_of_family;
  const Diagnosis d = diagnose(std::vector{soil}, {.num_resamples = 0, .num_repetitions = 0});
  REQUIRE(d.verdict == Verdict::set);
  REQUIRE(d.effects.empty());
  const std::set<std::string> set(d.set.begin(), d.set.end());
  REQUIRE(set == std::set<std::string>{"family", "linear", "quadratic"});
  REQUIRE_FALSE(d.set_holds_none);
  REQUIRE(d.posterior.inclusion[decoy] < 0.05);
  // Each of the three above both of log and offset.
  const Eigen::VectorXd& p = d.posterior.inclusion;
  REQUIRE(p.head(3).minCoeff() > 3.0 * std::max(p[logarithm], p[offset]));
  // One class: none of the three can be told from the others at the size the data ask for.
  const ProjectedEvidence e = analysed(soil).projected;
  Eigen::VectorXd lambda(6);
  for (Eigen::Index k = 0; k < 6; ++k) lambda[k] = std::pow(signed_scores(e)[k], 2);
  const auto groups =
      look_alike_groups(look_alike_map(e), lambda, {family, linear, quadratic, logarithm, offset});
  REQUIRE(groups.front() == std::vector<std::size_t>{family, linear, quadratic});
  REQUIRE(groups.back() == std::vector<std::size_t>{logarithm, offset});
}

TEST_CASE("Misra ladder: a single test is at most a suggestion even with one candidate",
          "[calibrate][diagnosis][misra]") {
  Ladder l = ladder();
  const double sigma = std::sqrt((1.2455138894e-01 - 0.111166366) / 11.0);
  l.model.jacobian /= sigma;
  l.model.fingerprints = Eigen::MatrixXd(l.model.fingerprints.col(linear) / sigma);
  const Diagnosis d =
      diagnose(std::vector{identity_soil(l.model, l.residual / sigma, {l.candidates[linear]})},
               {.num_resamples = 0, .num_repetitions = 0});
  REQUIRE(d.verdict == Verdict::suggested);
  REQUIRE(d.effects.front().num_supporting_experiments == 1);
}
