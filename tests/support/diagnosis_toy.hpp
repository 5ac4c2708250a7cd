// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The linear toy: hidden effects in made-up measurements, thousands of them in seconds.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "calibrate/diagnosis/effect_directions.hpp"
#include "calibrate/diagnosis/verdict.hpp"

namespace tilth::test {

/// Which of the statistics are measured.
enum class ToyData {
  core,    ///< all tests: 35 statistics
  extras,  ///< core and nine cheap further ones: 44
  field,   ///< draught and tracers only: 12
};

/// One simulated campaign.
struct ToyCase {
  SoilEvidence evidence;
  Eigen::VectorXd truth;  ///< (K) hidden sizes over typical ones
};

/// Log changes from data/effect_directions.csv: levels 0, 1, 2, 3 are 0, 0.06, 0.18, 0.40.
///
/// What the seeker does not know: the parameters are off by 5 %; a specimen's coefficient of
/// variation (5 to 25 %, 45 % for the scatter of tensile strength) and a packing's (7 %) differ
/// from what is usual for such statistics by a factor of exp(N(0, 0.25)); statistics of one
/// specimen correlate by 0.3. What it knows badly: derivatives and fingerprints come from eight
/// packings, whose paired runs correlate by 0.8, wherever the effect moves the experiment at all.
/// Five specimens per test.
class Toy {
 public:
  /// @param left_out  an id the seeker's catalogue lacks (the hider still has it), or ""
  explicit Toy(ToyData data, const std::string& left_out = "");

  Eigen::Index num_effects() const { return effects_.cols(); }
  const std::vector<std::string>& ids() const { return ids_; }
  const std::vector<std::string>& short_names() const { return short_names_; }
  const LinearModel& exact_model() const { return exact_; }
  const std::vector<CandidateEffect>& candidates() const { return candidates_; }
  /// Position in the seeker's catalogue of the hider's effect; empty if it was left out.
  std::optional<std::size_t> position(Eigen::Index effect) const;
  /// V as it is on average, without any estimation.
  Eigen::MatrixXd usual_covariance() const;

  /// Effects of the given sizes (over typical) are hidden.
  ToyCase hidden(const Eigen::VectorXd& sizes, std::mt19937_64& rng) const;
  ToyCase hidden(Eigen::Index effect, double size, std::mt19937_64& rng) const;
  /// Shifts of one to three experiments that look like no effect: |M r_w| = 8, all |cos| < 0.6.
  ToyCase outside(std::mt19937_64& rng) const;
  /// One effect at typical size, its true statistics shuffled among the experiments.
  ToyCase shuffled(Eigen::Index effect, std::mt19937_64& rng) const;
  /// The law acts in another form: 1 x typical plus a random vector of `share` of its length
  /// (whitened), in the experiments it moves.
  ToyCase distorted(Eigen::Index effect, double share, std::mt19937_64& rng) const;

 private:
  struct TestPlan {
    std::string name;
    std::vector<Eigen::Index> statistics;
  };
  ToyCase campaign(const Eigen::VectorXd& shift, const Eigen::VectorXd& truth,
                   std::mt19937_64& rng) const;
  TestSamples samples_of(const TestPlan& test, const Eigen::VectorXd& centre,
                         std::mt19937_64& rng) const;
  LinearModel seen_model(std::mt19937_64& rng) const;

  std::vector<std::string> ids_, short_names_;  // of the hider
  Eigen::MatrixXd effects_;                     // (p, K of the hider)
  LinearModel exact_;                           // fingerprints of the seeker's catalogue
  std::vector<CandidateEffect> candidates_;
  std::vector<TestPlan> tests_;
  NoisePriors noise_;
};

/// What the seeker said of one case.
enum class ToyAnswer { right, wrong, set, other, nothing };
/// A name is `named` or `suggested`; right if all names are true, wrong if one is not.
ToyAnswer answer_of(const Toy& toy, const Eigen::VectorXd& truth, const Diagnosis& diagnosis);

/// Counts of answers to many cases.
struct ToyTally {
  int num = 0;
  std::array<int, 5> answers{};
  int num_suggested = 0;
  void add(ToyAnswer answer, const Diagnosis& diagnosis) {
    ++num;
    ++answers[static_cast<std::size_t>(answer)];
    num_suggested += diagnosis.verdict == Verdict::suggested ? 1 : 0;
  }
  int count(ToyAnswer answer) const { return answers[static_cast<std::size_t>(answer)]; }
  double share(ToyAnswer answer) const { return static_cast<double>(count(answer)) / num; }
};

/// A case of the posterior's own prior: nothing 40 %, one effect 40 %, two 10 %, outside 10 %;
/// sizes half-normal over typical ones.
ToyCase case_of_prior(const Toy& toy, std::mt19937_64& rng);

/// How often effects with an inclusion probability in a bin were really there.
struct Reliability {
  static constexpr std::array<double, 6> edges = {0.02, 0.1, 0.3, 0.5, 0.8, 1.0};
  std::array<int, 5> num{}, num_true{};
  std::array<double, 5> sum{};
  void add(const Toy& toy, const ToyCase& made, const Posterior& posterior);
};

}  // namespace tilth::test
