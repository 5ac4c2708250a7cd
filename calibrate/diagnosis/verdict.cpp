// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/diagnosis/separability.hpp"
#include "calibrate/diagnosis/thresholds.hpp"

namespace tilth {
namespace {

using namespace diagnosis_thresholds;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double share_to_be_listed = 0.05;

// One diagnosis while it is made.
struct Work {
  std::span<const SoilEvidence> soils;
  std::vector<AnalysedSoil> analysed;
  std::vector<ProjectedEvidence> projected;
  const std::vector<CandidateEffect>& candidates;
  Diagnosis result;
};

void check(std::span<const SoilEvidence> soils) {
  if (soils.empty()) throw std::invalid_argument("a diagnosis needs at least one soil");
  for (const SoilEvidence& soil : soils)
    if (static_cast<Eigen::Index>(soil.candidates.size()) != soil.model.fingerprints.cols() ||
        !std::ranges::equal(soil.candidates, soils.front().candidates, {}, &CandidateEffect::id,
                            &CandidateEffect::id))
      throw std::invalid_argument(
          "every soil needs one fingerprint per candidate, and all soils "
          "the same candidates in the same order");
}

GlobalGap pooled(const std::vector<GlobalGap>& gaps) {
  GlobalGap sum;
  for (const GlobalGap& gap : gaps) {
    sum.chi_square += gap.chi_square;
    sum.nu += gap.nu;
  }
  if (sum.nu > 0.0)
    sum.tail_probability = f_tail(sum.chi_square / sum.nu, sum.nu, evidence_freedom);
  return sum;
}

GlobalGap gap_of_baseline(const Work& work) {
  std::vector<GlobalGap> gaps;
  for (const ProjectedEvidence& soil : work.projected) gaps.push_back(global_gap(soil));
  return pooled(gaps);
}

// What is left after the named effects. Their fingerprints are measured on few packings: at size
// alpha their noise alpha^2 N is part of the residual, and a large effect would else never pass.
GlobalGap gap_beyond_names(const Work& work) {
  std::vector<GlobalGap> gaps;
  for (std::size_t s = 0; s < work.soils.size(); ++s) {
    const LinearModel& model = work.soils[s].model;
    Eigen::MatrixXd v = work.analysed[s].noise.total();
    std::vector<Eigen::Index> names;
    for (const NamedEffect& effect : work.result.effects) {
      const auto k = static_cast<Eigen::Index>(effect.effect);
      names.push_back(k);
      const double size = effect.sizes[s].value;
      if (model.fingerprint_variances.size() > 0 && !std::isnan(size))
        v.diagonal() += size * size * model.fingerprint_variances.col(k);
    }
    gaps.push_back(gap_beyond(project(model, work.analysed[s].residual, v), names));
  }
  return pooled(gaps);
}

SoilDiagnosis detected(const SoilEvidence& soil, const ProjectedEvidence& projected,
                       const DiagnosisOptions& options) {
  SoilDiagnosis result;
  result.soil = soil.soil;
  result.gap = global_gap(projected);
  result.scores = effect_scores(projected, soil.candidates);
  result.look_alikes = look_alike_map(projected);
  result.bootstrap_tail = nan_value;
  if (options.num_repetitions <= 0) return result;
  const NullRepetitions null = null_repetitions(soil, options.num_repetitions, options.seed);
  result.bootstrap_tail = bootstrap_tail(null.chi_square, result.gap.chi_square);
  result.adjusted_tails.resize(static_cast<Eigen::Index>(result.scores.size()));
  for (std::size_t k = 0; k < result.scores.size(); ++k)
    result.adjusted_tails[static_cast<Eigen::Index>(k)] =
        std::isnan(result.scores[k].z)
            ? nan_value
            : bootstrap_tail(null.largest_score,
                             directed_score(result.scores[k].z, soil.candidates[k].sign));
  return result;
}

void list_set(Diagnosis& result, const std::vector<CandidateEffect>& candidates) {
  const CredibleSet set = credible_set(result.posterior, set_probability);
  for (const std::size_t k : set.effects) result.set.push_back(candidates[k].id);
  result.set_holds_none = set.none;
  result.set_holds_other = set.other;
}

std::vector<std::size_t> names_by_posterior(const Posterior& posterior) {
  std::vector<std::size_t> names;
  for (Eigen::Index k = 0; k < posterior.inclusion.size(); ++k)
    if (posterior.inclusion[k] > name_probability) names.push_back(static_cast<std::size_t>(k));
  return names;
}

int support_of(const Work& work, std::size_t name, const std::vector<std::size_t>& names) {
  std::vector<Eigen::Index> others;
  for (const std::size_t k : names)
    if (k != name) others.push_back(static_cast<Eigen::Index>(k));
  std::vector<ProjectedEvidence> rest;
  std::vector<double> typical;
  for (std::size_t s = 0; s < work.soils.size(); ++s) {
    rest.push_back(with_absorbed(work.projected[s], others));
    typical.push_back(work.soils[s].candidates[name].typical);
  }
  return num_supporting_experiments(rest, static_cast<Eigen::Index>(name),
                                    work.candidates[name].sign, typical);
}

void describe_names(Work& work, const std::vector<std::size_t>& names) {
  const auto sizes = effect_sizes(work.projected, work.candidates, names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(names[i]);
    const NamingStability& stability = work.result.stability;
    NamedEffect named{names[i],
                      work.candidates[names[i]].id,
                      work.result.posterior.inclusion[k],
                      stability.num_resamples > 0 ? stability.leading[k] : nan_value,
                      support_of(work, names[i], names),
                      {}};
    for (const auto& soil : sizes) named.sizes.push_back(soil[i]);
    work.result.effects.push_back(named);
  }
}

void demote_to_set(Work& work) {
  const auto add = [&](const std::string& id) {
    if (std::ranges::find(work.result.set, id) == work.result.set.end())
      work.result.set.push_back(id);
  };
  for (const NamedEffect& effect : work.result.effects) add(effect.id);
  for (std::size_t k = 0; k < work.candidates.size(); ++k)
    if (work.result.stability.leading[static_cast<Eigen::Index>(k)] >= share_to_be_listed)
      add(work.candidates[k].id);
  work.result.effects.clear();
  work.result.verdict = Verdict::set;
  work.result.reason = fmt::format(
      "resampled specimens and packings name it in less than {:.0f} % "
      "of cases",
      100.0 * least_stability);
}

// Of a pair, each effect leads in some resamples; together they must.
double joint_stability(const Diagnosis& result) {
  double sum = 0.0;
  for (const NamedEffect& effect : result.effects) sum += effect.stability;
  return sum;
}

void decide_with_names(Work& work, const std::vector<std::size_t>& names) {
  Diagnosis& result = work.result;
  describe_names(work, names);
  result.gap_after = gap_beyond_names(work);
  if (result.gap_after.tail_probability < residual_level) {
    result.verdict = Verdict::outside_catalogue;
    result.reason = fmt::format("{} is the nearest candidate, but a gap beyond noise is left",
                                result.effects.front().id);
    result.effects.clear();
    return;
  }
  if (joint_stability(result) < least_stability) return demote_to_set(work);
  const bool several = std::ranges::all_of(
      result.effects, [](const NamedEffect& e) { return e.num_supporting_experiments >= 2; });
  result.verdict = several ? Verdict::named : Verdict::suggested;
  result.reason = several ? "one explanation stands out in at least two experiments"
                          : "one explanation stands out, but it rests on one kind of experiment";
}

bool could_have_been_seen(const Diagnosis& result) {
  return std::ranges::any_of(result.soils, [](const SoilDiagnosis& soil) {
    return std::ranges::any_of(soil.scores,
                               [](const EffectScore& s) { return s.power >= high_power; });
  });
}

void decide_without_names(Work& work) {
  Diagnosis& result = work.result;
  const double best =
      result.posterior.inclusion.size() > 0 ? result.posterior.inclusion.maxCoeff() : 0.0;
  result.gap_after = result.gap_before;
  if (result.posterior.other >= std::max(best, result.posterior.none)) {
    result.verdict = Verdict::outside_catalogue;
    result.reason = "a gap beyond noise that no candidate describes";
  } else if (best > result.posterior.none) {
    result.verdict = Verdict::set;
    result.reason = "several candidates describe the gap about equally well";
  } else if (result.gap_before.tail_probability < gap_level) {
    result.verdict = Verdict::inconclusive;
    result.reason = "a gap beyond noise, too small to be explained";
  } else if (!could_have_been_seen(result)) {
    result.verdict = Verdict::inconclusive;
    result.reason = "no gap found, but no candidate of interest could have been seen";
  } else {
    result.verdict = Verdict::none;
    result.reason = "no gap larger than noise";
  }
}

bool has_anything_to_test(Work& work) {
  if (gap_of_baseline(work).nu > 0.0) return true;
  work.result.reason = "as many free parameters as independent statistics: nothing is left to test";
  return false;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "none";
    case Verdict::named:
      return "named";
    case Verdict::suggested:
      return "suggested";
    case Verdict::set:
      return "set";
    case Verdict::outside_catalogue:
      return "outside_catalogue";
    case Verdict::inconclusive:
      break;
  }
  return "inconclusive";
}

Diagnosis diagnose(std::span<const SoilEvidence> soils, const DiagnosisOptions& options) {
  check(soils);
  Work work{soils, {}, {}, soils.front().candidates, {}};
  for (const SoilEvidence& soil : soils) {
    work.analysed.push_back(analysed(soil));
    work.projected.push_back(work.analysed.back().projected);
  }
  if (!has_anything_to_test(work)) return work.result;

  std::vector<EvidenceTerms> terms;
  for (std::size_t s = 0; s < soils.size(); ++s) {
    work.result.soils.push_back(detected(soils[s], work.projected[s], options));
    terms.push_back(evidence_terms(work.projected[s], soils[s].candidates));
  }
  work.result.gap_before = gap_of_baseline(work);
  work.result.posterior = posterior(terms, work.candidates);
  list_set(work.result, work.candidates);
  const std::vector<std::size_t> names = names_by_posterior(work.result.posterior);
  work.result.stability =
      naming_stability(soils, names.empty() ? 0 : options.num_resamples, options.seed + 1);
  if (names.empty())
    decide_without_names(work);
  else
    decide_with_names(work, names);
  return work.result;
}

}  // namespace tilth
