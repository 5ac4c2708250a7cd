// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/verdict.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <stdexcept>

#include "tests/calibrate/diagnosis/small_models.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

constexpr DiagnosisOptions quick = {.num_resamples = 0, .num_repetitions = 0};

// Four experiments of three statistics, one parameter, V = 1. Effects: e0 moves all experiments, e1
// experiment a alone, e2 the last two, e3 looks like e2.
struct Setup {
  std::mt19937_64 rng{21};
  LinearModel model = random_model(12, 1, 4, rng);
  Setup() {
    model.fingerprints.col(0) *= 3.0;
    model.fingerprints.col(1) *= 5.0;
    model.fingerprints.col(1).tail(9).setZero();
    model.fingerprints.col(2) *= 3.0;
    model.fingerprints.col(2).head(6).setZero();
    model.fingerprints.col(3) = model.fingerprints.col(2) + 0.05 * model.fingerprints.col(3);
  }
  Diagnosis of(const Eigen::VectorXd& residual, const DiagnosisOptions& options = quick) const {
    return diagnose(std::vector{identity_soil(model, residual, unit_candidates(4))}, options);
  }
  Eigen::VectorXd effect(Eigen::Index k, double size = 1.0) const {
    return size * model.fingerprints.col(k);
  }
};

}  // namespace

TEST_CASE("Verdict: no residual and enough power is none", "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const Diagnosis d = s.of(Eigen::VectorXd::Zero(12));
  REQUIRE(d.verdict == Verdict::none);
  REQUIRE(d.effects.empty());
  REQUIRE(d.set_holds_none);
  // Parameters alone make no gap either.
  REQUIRE(s.of(7.0 * s.model.jacobian.col(0)).verdict == Verdict::none);
}

TEST_CASE("Verdict: one effect in all experiments is named, with its size",
          "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const Diagnosis d = s.of(s.effect(0) + 2.0 * s.model.jacobian.col(0));
  REQUIRE(d.verdict == Verdict::named);
  REQUIRE(d.effects.size() == 1);
  REQUIRE(d.effects[0].id == "e0");
  REQUIRE(d.effects[0].posterior > 0.95);
  REQUIRE(d.effects[0].num_supporting_experiments >= 2);
  REQUIRE_THAT(d.effects[0].sizes.at(0).value, WithinRel(1.0, 1e-9));
  REQUIRE(std::isnan(d.effects[0].stability));
  REQUIRE(d.set == std::vector<std::string>{"e0"});
  REQUIRE(d.gap_before.tail_probability < 1e-6);
  REQUIRE_THAT(d.gap_after.chi_square, WithinAbs(0.0, 1e-9));
  REQUIRE(d.gap_after.nu == d.gap_before.nu - 1.0);
}

TEST_CASE("Verdict: an effect that moves one rig only is suggested, however strong",
          "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const Diagnosis d = s.of(s.effect(1));
  REQUIRE(d.verdict == Verdict::suggested);
  REQUIRE(d.effects.at(0).id == "e1");
  REQUIRE(d.effects[0].num_supporting_experiments == 1);
}

TEST_CASE("Verdict: look-alikes are a set", "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const Diagnosis d = s.of(s.effect(2));
  REQUIRE(d.verdict == Verdict::set);
  REQUIRE(d.effects.empty());
  REQUIRE(std::set<std::string>(d.set.begin(), d.set.end()) == std::set<std::string>{"e2", "e3"});
  REQUIRE_FALSE(d.set_holds_none);
  REQUIRE_FALSE(d.set_holds_other);
}

TEST_CASE("Verdict: two effects are both named", "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const Diagnosis d = s.of(s.effect(0, 2.0) + s.effect(1, 2.0));
  REQUIRE(d.effects.size() == 2);
  REQUIRE(d.effects[0].id == "e0");
  REQUIRE(d.effects[1].id == "e1");
  REQUIRE_THAT(d.effects[1].sizes[0].value, WithinRel(2.0, 1e-9));
  // One of the two rests on a single rig.
  REQUIRE(d.verdict == Verdict::suggested);
}

TEST_CASE("Verdict: a gap like no candidate is outside the catalogue",
          "[calibrate][diagnosis][verdict]") {
  Setup s;
  Eigen::MatrixXd known(12, 5);
  known << s.model.jacobian, s.model.fingerprints;
  Eigen::VectorXd strange = normal_matrix(12, 1, s.rng);
  strange -= known * known.colPivHouseholderQr().solve(strange);
  REQUIRE(s.of(12.0 * strange.normalized()).verdict == Verdict::outside_catalogue);
  // A name that leaves a gap behind is not enough either.
  const Diagnosis d = s.of(s.effect(0, 4.0) + 9.0 * strange.normalized());
  REQUIRE(d.posterior.inclusion[0] > 0.8);
  REQUIRE(d.verdict == Verdict::outside_catalogue);
  REQUIRE(d.effects.empty());
  REQUIRE_THAT(d.reason, Contains("e0 is the nearest"));
}

TEST_CASE("Verdict: nothing found where nothing could be seen is inconclusive",
          "[calibrate][diagnosis][verdict]") {
  Setup s;
  s.model.fingerprints *= 0.05;
  const Diagnosis d = s.of(Eigen::VectorXd::Zero(12));
  REQUIRE(d.verdict == Verdict::inconclusive);
  REQUIRE_THAT(d.reason, Contains("could have been seen"));
}

TEST_CASE("Verdict: too few data have their own answer, not an error",
          "[calibrate][diagnosis][verdict]") {
  Setup s;
  s.model.jacobian = Eigen::MatrixXd::Identity(12, 12);
  const Diagnosis d = s.of(s.effect(0));
  REQUIRE(d.verdict == Verdict::inconclusive);
  REQUIRE_THAT(d.reason, Contains("nothing is left to test"));
  // No candidate has a fingerprint.
  Setup flat;
  flat.model.fingerprints.setZero();
  REQUIRE(flat.of(Eigen::VectorXd::Zero(12)).verdict == Verdict::inconclusive);
  REQUIRE(flat.of(Eigen::VectorXd::Constant(12, 9.0)).verdict == Verdict::outside_catalogue);
}

TEST_CASE("Verdict: a name that resamples do not repeat becomes a set",
          "[calibrate][diagnosis][verdict]") {
  // Ten specimens per statistic whose mean asks for e0, because one of them is far off: V knows it
  // as scatter only in part (its prior is tight), resamples without that specimen do not see e0.
  Setup s;
  SoilEvidence soil = identity_soil(s.model, Eigen::VectorXd::Zero(12), unit_candidates(4));
  soil.noise.freedom = 1e6;
  soil.noise.replicate_variances.setConstant(10.0);
  for (TestSamples& test : soil.samples) test.replicates = Eigen::MatrixXd::Zero(10, 1);
  // All experiments as one test, so that the specimens are drawn together.
  TestSamples joint{{}, Eigen::MatrixXd::Zero(10, 12), Eigen::MatrixXd::Zero(1, 12)};
  for (Eigen::Index i = 0; i < 12; ++i) joint.statistics.push_back(i);
  joint.replicates.row(3) = 10.0 * s.effect(0).transpose();
  soil.samples = {joint};
  soil.noise.correlation = 0.0;
  REQUIRE(diagnose(std::vector{soil}, quick).verdict == Verdict::named);
  const Diagnosis d = diagnose(std::vector{soil}, {.num_resamples = 100, .num_repetitions = 0});
  REQUIRE(d.stability.leading[0] < 0.8);  // a specimen is drawn at least once in 65 %
  REQUIRE(d.verdict == Verdict::set);
  REQUIRE(d.effects.empty());
  REQUIRE(d.set.front() == "e0");
}

TEST_CASE("Verdict: three soils together see what one cannot", "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const SoilEvidence weak =
      identity_soil(s.model, s.effect(0, 2.5 / s.effect(0).norm()), unit_candidates(4));
  REQUIRE(diagnose(std::vector{weak}, quick).verdict != Verdict::named);
  const Diagnosis d = diagnose(std::vector{weak, weak, weak, weak}, quick);
  REQUIRE(d.soils.size() == 4);
  REQUIRE(d.posterior.inclusion[0] > 0.8);
  REQUIRE(d.verdict == Verdict::named);
  REQUIRE(d.effects[0].sizes.size() == 4);
}

TEST_CASE("Verdict: the bootstrap adjusts for the largest of many scores",
          "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const Diagnosis d = s.of(s.effect(0), {.num_resamples = 20, .num_repetitions = 199, .seed = 4});
  const SoilDiagnosis& soil = d.soils.at(0);
  REQUIRE(soil.bootstrap_tail == 0.005);
  REQUIRE(soil.adjusted_tails[0] == 0.005);
  for (std::size_t k = 0; k < soil.scores.size(); ++k) {
    const double alone = normal_cdf(-soil.scores[k].z);
    // A maximum over candidates is never easier to reach; 0.03 is three errors of 199 repetitions.
    REQUIRE(soil.adjusted_tails[static_cast<Eigen::Index>(k)] > alone - 0.03);
  }
  REQUIRE(d.effects.at(0).stability > 0.9);
}

TEST_CASE("Verdict: order of candidates and statistics does not matter",
          "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const Eigen::VectorXd r = s.effect(0, 0.6) + s.effect(2, 0.3);
  const Diagnosis d = s.of(r);
  Setup turned;
  const std::vector<Eigen::Index> rows = {11, 3, 7, 0, 5, 2, 9, 1, 10, 4, 8, 6};
  turned.model = selected_rows(s.model, r, Eigen::MatrixXd::Identity(12, 12), rows).model;
  turned.model.fingerprints = Eigen::MatrixXd(turned.model.fingerprints.rowwise().reverse());
  auto candidates = unit_candidates(4);
  std::ranges::reverse(candidates);
  const Diagnosis e =
      diagnose(std::vector{identity_soil(turned.model, r(rows), candidates)}, quick);
  REQUIRE(e.verdict == d.verdict);
  // 1e-9: sums in another order.
  REQUIRE_THAT((e.posterior.inclusion.reverse() - d.posterior.inclusion).norm(),
               WithinAbs(0.0, 1e-9));
}

TEST_CASE("Verdict: soils with different candidates are refused",
          "[calibrate][diagnosis][verdict]") {
  const Setup s;
  const SoilEvidence soil = identity_soil(s.model, Eigen::VectorXd::Zero(12), unit_candidates(4));
  SoilEvidence other = soil;
  std::swap(other.candidates[0], other.candidates[1]);
  REQUIRE_THROWS_AS(diagnose(std::vector{soil, other}, quick), std::invalid_argument);
  other.candidates.pop_back();
  REQUIRE_THROWS_AS(diagnose(std::vector{other}, quick), std::invalid_argument);
  REQUIRE_THROWS_AS(diagnose(std::vector<SoilEvidence>{}, quick), std::invalid_argument);
  REQUIRE_THAT(Diagnosis{}.reason, Equals("diagnose() was not called"));
}
