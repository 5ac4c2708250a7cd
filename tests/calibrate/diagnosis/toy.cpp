// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Tier 0: thousands of hidden effects in the linear toy. Bounds are those the project promises; a
// larger run with all rows is `build/release/bin/diagnosis_toy` (docs/benchmarks.md).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <span>

#include "calibrate/diagnosis/separability.hpp"
#include "tests/support/binomial.hpp"
#include "tests/support/diagnosis_toy.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

constexpr DiagnosisOptions fast = {.num_resamples = 0, .num_repetitions = 0};

Diagnosis diagnosed(const ToyCase& made, const DiagnosisOptions& options = fast) {
  return diagnose(std::span(&made.evidence, 1), options);
}

template <typename Make>
ToyTally tally(const Toy& toy, int num, const Make& make) {
  ToyTally counts;
  for (int i = 0; i < num; ++i) {
    const ToyCase made = make(i);
    const Diagnosis d = diagnosed(made);
    counts.add(answer_of(toy, made.truth, d), d);
  }
  return counts;
}

// Exact one-sided p-value of seeing that many or more if the rate were `rate`.
double p_of_more(int count, int num, double rate) {
  return count == 0 ? 1.0 : 1.0 - binomial_cdf(count - 1, num, rate);
}

double p_of_fewer(int count, int num, double rate) { return binomial_cdf(count, num, rate); }

Eigen::Index effect_of(const Toy& toy, int i) { return i % toy.num_effects(); }

}  // namespace

TEST_CASE("Toy: as many statistics, parameters and effects as it claims",
          "[calibrate][diagnosis][toy]") {
  REQUIRE(Toy(ToyData::core).exact_model().statistics.size() == 35);
  REQUIRE(Toy(ToyData::extras).exact_model().statistics.size() == 44);
  REQUIRE(Toy(ToyData::field).exact_model().statistics.size() == 12);
  REQUIRE(Toy(ToyData::core).exact_model().jacobian.cols() == 7);
  REQUIRE(Toy(ToyData::core).num_effects() == 16);
  REQUIRE(Toy(ToyData::core, "tool_adhesion").candidates().size() == 15);
}

TEST_CASE("Toy: where nothing is hidden, at most 2 % of campaigns get a name",
          "[calibrate][diagnosis][toy]") {
  const ToyData data = GENERATE(ToyData::core, ToyData::extras, ToyData::field);
  const Toy toy(data);
  std::mt19937_64 rng(101);
  const ToyTally counts = tally(
      toy, 1000, [&](int) { return toy.hidden(Eigen::VectorXd::Zero(toy.num_effects()), rng); });
  // Red if the rate is above 2 % beyond doubt (1e-3), and no campaign is simply left unanswered.
  REQUIRE(p_of_more(counts.count(ToyAnswer::wrong), counts.num, 0.02) > 1e-3);
  REQUIRE(counts.share(ToyAnswer::nothing) > 0.85);
}

TEST_CASE("Toy: effects of typical size are named, and rarely wrongly",
          "[calibrate][diagnosis][toy]") {
  const bool extras = GENERATE(false, true);
  const Toy toy(extras ? ToyData::extras : ToyData::core);
  std::mt19937_64 rng(102);
  const ToyTally counts =
      tally(toy, 960, [&](int i) { return toy.hidden(effect_of(toy, i), 1.0, rng); });
  // 65 % is promised for the core; with the extras 80 %.
  REQUIRE(p_of_fewer(counts.count(ToyAnswer::right), counts.num, extras ? 0.80 : 0.65) > 1e-3);
  REQUIRE(p_of_more(counts.count(ToyAnswer::wrong), counts.num, 0.02) > 1e-3);
}

TEST_CASE("Toy: weak and strong effects are hardly ever named wrongly",
          "[calibrate][diagnosis][toy]") {
  const double size = GENERATE(0.5, 2.0);
  const Toy toy(ToyData::core);
  std::mt19937_64 rng(103);
  const ToyTally counts =
      tally(toy, 960, [&](int i) { return toy.hidden(effect_of(toy, i), size, rng); });
  REQUIRE(p_of_more(counts.count(ToyAnswer::wrong), counts.num, 0.02) > 1e-3);
  if (size == 2.0) REQUIRE(p_of_fewer(counts.count(ToyAnswer::right), counts.num, 0.90) > 1e-3);
}

TEST_CASE("Toy: a discrepancy like no candidate gets no soil name", "[calibrate][diagnosis][toy]") {
  const Toy toy(ToyData::core);
  std::mt19937_64 rng(104);
  const ToyTally counts = tally(toy, 800, [&](int) { return toy.outside(rng); });
  REQUIRE(p_of_more(counts.count(ToyAnswer::wrong), counts.num, 0.05) > 1e-3);
  REQUIRE(p_of_fewer(counts.count(ToyAnswer::other), counts.num, 0.75) > 1e-3);
}

TEST_CASE("Toy: an effect that the catalogue lacks is rarely taken for another",
          "[calibrate][diagnosis][toy]") {
  // With resampling: without it 17 % of the core's cases get the name of a look-alike.
  const Toy all(ToyData::core);
  std::mt19937_64 rng(105);
  int wrong = 0;
  int num = 0;
  for (Eigen::Index k = 0; k < all.num_effects(); ++k) {
    const Toy toy(ToyData::core, all.ids()[static_cast<std::size_t>(k)]);
    for (int i = 0; i < 20; ++i, ++num) {
      const Diagnosis d =
          diagnosed(toy.hidden(k, 1.0, rng), {.num_resamples = 30, .num_repetitions = 0});
      wrong += d.effects.empty() ? 0 : 1;
    }
  }
  REQUIRE(p_of_more(wrong, num, 0.10) > 1e-2);  // promised: 10 %
}

TEST_CASE("Toy: shuffled among the experiments an effect is not recognised",
          "[calibrate][diagnosis][toy]") {
  const Toy toy(ToyData::core);
  std::mt19937_64 rng(106);
  const ToyTally counts =
      tally(toy, 800, [&](int i) { return toy.shuffled(effect_of(toy, i), rng); });
  // Two names in a hundred are the level of nulls and decoys.
  REQUIRE(p_of_more(counts.count(ToyAnswer::wrong), counts.num, 0.02) > 1e-3);
}

TEST_CASE("Toy: of two effects at least one is named and few are false",
          "[calibrate][diagnosis][toy]") {
  const Toy toy(ToyData::core);
  std::mt19937_64 rng(107);
  const ToyTally counts = tally(toy, 600, [&](int i) {
    Eigen::VectorXd sizes = Eigen::VectorXd::Zero(toy.num_effects());
    sizes[effect_of(toy, i)] = 1.0;
    sizes[effect_of(toy, i + 1 + static_cast<int>(rng() % 15))] = 1.0;
    return toy.hidden(sizes, rng);
  });
  REQUIRE(p_of_fewer(counts.count(ToyAnswer::right), counts.num, 0.80) > 1e-3);
  REQUIRE(p_of_more(counts.count(ToyAnswer::wrong), counts.num, 0.05) > 1e-3);
}

TEST_CASE("Toy: probabilities mean what they say", "[calibrate][diagnosis][toy]") {
  const Toy toy(ToyData::core);
  std::mt19937_64 rng(108);
  Reliability bins;
  for (int i = 0; i < 1500; ++i) {
    const ToyCase made = case_of_prior(toy, rng);
    bins.add(toy, made, diagnosed(made).posterior);
  }
  for (std::size_t bin = 0; bin < bins.num.size(); ++bin) {
    INFO("bin " << bin << ": " << bins.num_true[bin] << " of " << bins.num[bin]);
    const double said = bins.sum[bin] / bins.num[bin];
    const double error = std::sqrt(said * (1.0 - said) / bins.num[bin]);
    // Within ten points, and three standard errors where the bin is small.
    REQUIRE(std::abs(static_cast<double>(bins.num_true[bin]) / bins.num[bin] - said) <
            0.10 + 3.0 * error);
  }
  // Names: within five points.
  REQUIRE(static_cast<double>(bins.num_true[4]) / bins.num[4] > bins.sum[4] / bins.num[4] - 0.05);
}

TEST_CASE("Toy: the 95 % set holds the truth and the size interval does too",
          "[calibrate][diagnosis][toy]") {
  const Toy toy(ToyData::core);
  std::mt19937_64 rng(109);
  int holds = 0;
  int covered = 0;
  int named = 0;
  std::size_t size = 0;
  const int num = 800;
  for (int i = 0; i < num; ++i) {
    const Eigen::Index k = effect_of(toy, i);
    const Diagnosis d = diagnosed(toy.hidden(k, 1.0, rng));
    const std::string& id = toy.ids()[static_cast<std::size_t>(k)];
    holds += std::ranges::find(d.set, id) != d.set.end() ? 1 : 0;
    size += d.set.size() + (d.set_holds_none ? 1 : 0) + (d.set_holds_other ? 1 : 0);
    for (const NamedEffect& effect : d.effects)
      if (effect.id == id) {
        ++named;
        covered += effect.sizes[0].lo90 <= 1.0 && 1.0 <= effect.sizes[0].hi90 ? 1 : 0;
      }
  }
  REQUIRE(p_of_fewer(holds, num, 0.90) > 1e-3);
  REQUIRE(static_cast<double>(size) / num < 3.0);
  // Promised: 80 to 97 %.
  REQUIRE(p_of_fewer(covered, named, 0.80) > 1e-3);
  REQUIRE(p_of_more(covered, named, 0.97) > 1e-3);
}

TEST_CASE("Toy: draught and tracers alone name nothing", "[calibrate][diagnosis][toy]") {
  const Toy toy(ToyData::field);
  std::mt19937_64 rng(110);
  int unseen = 0;
  const ToyTally counts = tally(toy, 480, [&](int i) {
    const ToyCase made = toy.hidden(effect_of(toy, i), 1.0, rng);
    unseen += diagnosed(made).verdict == Verdict::inconclusive ? 1 : 0;
    return made;
  });
  REQUIRE(p_of_more(counts.count(ToyAnswer::wrong) + counts.count(ToyAnswer::right), counts.num,
                    0.02) > 1e-3);
  // "Could not have been seen", not "nothing is missing".
  REQUIRE(unseen > 0.9 * counts.num);
}

TEST_CASE("Toy: the laboratory is the next experiment for what draught cannot separate",
          "[calibrate][diagnosis][toy]") {
  const Toy field(ToyData::field);
  const Toy all(ToyData::extras);
  const Eigen::MatrixXd v = all.usual_covariance();
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(v.rows());
  const auto offer = [&](const std::string& name, const std::vector<std::string>& rigs) {
    std::vector<Eigen::Index> rows;
    for (const std::string& rig : rigs)
      for (const Eigen::Index i : rows_of(all.exact_model(), rig)) rows.push_back(i);
    const EvidenceRows part = selected_rows(all.exact_model(), nothing, v, rows);
    return PossibleExperiment{name, part.model, part.covariance, 1.0};
  };
  const auto k = [&](const std::string& id) {
    return static_cast<std::size_t>(std::ranges::find(all.ids(), id) - all.ids().begin());
  };
  const auto advice = next_experiments(
      field.exact_model(), field.usual_covariance(), {k("tool_adhesion"), k("plastic_contact")},
      Eigen::VectorXd::Ones(all.num_effects()),
      {offer("tension", {"brazilian"}),
       offer("laboratory",
             {"unconfined_compression", "direct_shear", "oedometer", "steel_shear"})});
  // Draught and tracers alone: nothing of either is left. Tension tests see neither.
  REQUIRE(advice[0].name == "laboratory");
  REQUIRE_THAT(advice[0].separation_before, Catch::Matchers::WithinAbs(0.0, 1e-9));
  REQUIRE(advice[0].separation_after > 5.4);
  REQUIRE(advice[0].ordering_after > 0.95);
  REQUIRE_THAT(advice[1].separation_after, Catch::Matchers::WithinAbs(0.0, 1e-9));
}
