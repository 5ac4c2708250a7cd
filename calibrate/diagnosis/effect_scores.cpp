// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/effect_scores.hpp"

#include <cmath>
#include <limits>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/diagnosis/thresholds.hpp"

namespace tilth {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

double critical_score(EffectSign sign, double level) {
  return -normal_quantile(sign == EffectSign::positive ? level : 0.5 * level);
}

EffectDecision decision_of(const EffectScore& score, const CandidateEffect& effect) {
  using diagnosis_thresholds::high_power;
  using diagnosis_thresholds::test_level;
  const bool significant =
      directed_score(score.z, effect.sign) > critical_score(effect.sign, test_level);
  const bool powerful = score.power >= high_power;
  if (!significant) return powerful ? EffectDecision::absent : EffectDecision::inconclusive;
  if (!powerful) return EffectDecision::misspecified;
  return std::abs(score.expected_change) < effect.of_interest ? EffectDecision::absent
                                                              : EffectDecision::misspecified;
}

EffectScore score_of(const ProjectedEvidence& evidence, Eigen::Index k,
                     const CandidateEffect& effect) {
  using diagnosis_thresholds::high_power;
  using diagnosis_thresholds::test_level;
  EffectScore score;
  score.kept = evidence.kept[k];
  if (!evidence.is_measurable(k)) {
    score.z = score.modification_index = score.expected_change = score.standard_error =
        score.power = score.smallest_visible = nan_value;
    return score;
  }
  const double norm = evidence.fingerprints.col(k).norm();
  score.z = evidence.fingerprints.col(k).dot(evidence.u) / norm;
  score.modification_index = std::pow(std::fmax(0.0, directed_score(score.z, effect.sign)), 2);
  score.expected_change = score.z / norm;
  score.standard_error = 1.0 / norm;
  score.power = test_power(effect.of_interest * norm, effect.sign, test_level);
  // The far tail of a two-sided test is below 1e-6 here.
  score.smallest_visible =
      (critical_score(effect.sign, test_level) + normal_quantile(high_power)) / norm;
  score.opposite = effect.sign == EffectSign::positive &&
                   -score.z > critical_score(EffectSign::positive, test_level);
  score.decision = decision_of(score, effect);
  return score;
}

}  // namespace

std::string_view to_string(EffectDecision decision) {
  switch (decision) {
    case EffectDecision::inconclusive:
      return "inconclusive";
    case EffectDecision::misspecified:
      return "misspecified";
    case EffectDecision::absent:
      return "absent";
    case EffectDecision::not_measurable:
      break;
  }
  return "not_measurable";
}

double test_power(double shift, EffectSign sign, double level) {
  const double critical = critical_score(sign, level);
  const double far = sign == EffectSign::free ? normal_cdf(-shift - critical) : 0.0;
  return normal_cdf(shift - critical) + far;
}

std::vector<EffectScore> effect_scores(const ProjectedEvidence& evidence,
                                       const std::vector<CandidateEffect>& candidates) {
  std::vector<EffectScore> scores;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    scores.push_back(score_of(evidence, static_cast<Eigen::Index>(k), candidates[k]));
  return scores;
}

Eigen::VectorXd signed_scores(const ProjectedEvidence& evidence) {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(evidence.fingerprints.cols());
  for (Eigen::Index k = 0; k < z.size(); ++k)
    if (evidence.is_measurable(k)) {
      const auto f = evidence.fingerprints.col(k);
      z[k] = f.dot(evidence.u) / f.norm();
    }
  return z;
}

double directed_score(double z, EffectSign sign) {
  return sign == EffectSign::free ? std::abs(z) : z;
}

double scale_free_f(double modification_index, double chi_square, Eigen::Index nu) {
  return modification_index / (chi_square - modification_index) * static_cast<double>(nu - 1);
}

}  // namespace tilth
