// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/effect_scores.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/diagnosis/small_models.hpp"
#include "tests/support/binomial.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// One statistic, no parameter, V = 1: z is the residual times the sign of the fingerprint.
EffectScore score_of_one(double residual, double fingerprint, EffectSign sign, double of_interest) {
  LinearModel model;
  model.statistics = {{"a", "x"}};
  model.jacobian.resize(1, 0);
  model.fingerprints = Eigen::MatrixXd::Constant(1, 1, fingerprint);
  const ProjectedEvidence e =
      project(model, Eigen::VectorXd::Constant(1, residual), Eigen::MatrixXd::Identity(1, 1));
  return effect_scores(e, {{"e", sign, 1.0, of_interest, false}}).front();
}

}  // namespace

TEST_CASE("Scores: the decision table of Saris and Satorra, all five rows",
          "[calibrate][diagnosis]") {
  const auto decision = [](double z, double power_shift) {
    return score_of_one(z, 1.0, EffectSign::positive, power_shift).decision;
  };
  REQUIRE(decision(0.5, 1.0) == EffectDecision::inconclusive);  // not significant, power 26 %
  REQUIRE(decision(2.0, 1.0) == EffectDecision::misspecified);  // significant, power low
  REQUIRE(decision(0.5, 4.0) == EffectDecision::absent);        // not significant, power 99 %
  REQUIRE(decision(2.0, 4.0) == EffectDecision::absent);        // significant, half of interest
  REQUIRE(decision(5.0, 4.0) == EffectDecision::misspecified);  // significant and large enough
}

TEST_CASE("Scores: an effect that can only be positive is not asked for by a negative score",
          "[calibrate][diagnosis]") {
  const EffectScore down = score_of_one(-3.0, 1.0, EffectSign::positive, 4.0);
  REQUIRE(down.modification_index == 0.0);
  REQUIRE(down.opposite);
  REQUIRE(down.decision == EffectDecision::absent);
  REQUIRE_FALSE(score_of_one(-1.5, 1.0, EffectSign::positive, 4.0).opposite);
  const EffectScore free = score_of_one(-3.0, 1.0, EffectSign::free, 4.0);
  REQUIRE_THAT(free.modification_index, WithinRel(9.0, 1e-14));
  REQUIRE_FALSE(free.opposite);
  // A fingerprint of the other sign turns the score round.
  REQUIRE_THAT(score_of_one(-3.0, -2.0, EffectSign::positive, 4.0).z, WithinRel(3.0, 1e-14));
  REQUIRE_THAT(score_of_one(-3.0, -2.0, EffectSign::positive, 4.0).expected_change,
               WithinRel(1.5, 1e-14));
}

TEST_CASE("Scores: power is the rate at which repetitions are significant",
          "[calibrate][diagnosis]") {
  const EffectSign sign = GENERATE(EffectSign::positive, EffectSign::free);
  const double shift = GENERATE(0.7, 2.5);
  std::mt19937_64 rng(7);
  const double critical = sign == EffectSign::positive ? 1.644853627 : 1.959963985;
  int seen = 0;
  const int n = 4000;
  for (int i = 0; i < n; ++i)
    seen += directed_score(shift + standard_normal(rng), sign) > critical ? 1 : 0;
  REQUIRE(binomial_tail(seen, n, test_power(shift, sign, 0.05)) > 1e-4);
}

TEST_CASE("Scores: noncentralities of a Bonferroni test of sixteen effects",
          "[calibrate][diagnosis]") {
  // One-sided 5 % / 16: z > 2.73; 80, 90 and 95 % power need 12.8, 16.1 and 19.2 (two decimals).
  const double level = 0.05 / 16.0;
  REQUIRE_THAT(test_power(std::sqrt(12.8), EffectSign::positive, level), WithinAbs(0.80, 0.005));
  REQUIRE_THAT(test_power(std::sqrt(16.1), EffectSign::positive, level), WithinAbs(0.90, 0.005));
  REQUIRE_THAT(test_power(std::sqrt(19.2), EffectSign::positive, level), WithinAbs(0.95, 0.005));
}

TEST_CASE("Scores: the smallest visible size is seen in 80 % of cases", "[calibrate][diagnosis]") {
  const EffectScore s = score_of_one(0.0, 2.0, EffectSign::positive, 1.0);
  REQUIRE_THAT(test_power(s.smallest_visible / s.standard_error, EffectSign::positive, 0.05),
               WithinRel(0.8, 1e-12));
  const EffectScore two = score_of_one(0.0, 2.0, EffectSign::free, 1.0);
  // 1e-5: the far tail is left out.
  REQUIRE_THAT(test_power(two.smallest_visible / two.standard_error, EffectSign::free, 0.05),
               WithinRel(0.8, 1e-5));
}
