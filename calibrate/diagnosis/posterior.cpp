// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/posterior.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/diagnosis/thresholds.hpp"

namespace tilth {
namespace {

using namespace diagnosis_thresholds;

constexpr std::array<double, 6> other_scales = {0.3, 0.7, 1.5, 3.0, 6.0, 12.0};

std::vector<Eigen::Index> columns_of(const Explanation& explanation) {
  return {explanation.effects.begin(), explanation.effects.end()};
}

// log of a t density with scale matrix s I, without its constant.
double log_student(double squared_norm, double nu, double scale) {
  return -0.5 * nu * std::log(scale) -
         0.5 * (evidence_freedom + nu) * std::log1p(squared_norm / (scale * evidence_freedom));
}

double log_sum(std::span<const double> logs) {
  const double largest = *std::ranges::max_element(logs);
  double sum = 0.0;
  for (const double x : logs) sum += std::exp(x - largest);
  return largest + std::log(sum);
}

double log_evidence_of_other(const EvidenceTerms& terms) {
  std::array<double, other_scales.size()> logs{};
  for (std::size_t i = 0; i < logs.size(); ++i)
    logs[i] = log_student(terms.squared_norm, terms.nu, 1.0 + other_scales[i]);
  return log_sum(logs) - std::log(static_cast<double>(logs.size()));
}

// log of P(signs | u) / P(signs) for a normal posterior.
double log_sign_ratio(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                      const std::vector<bool>& positive) {
  const Eigen::VectorXd z = mean.array() / covariance.diagonal().array().sqrt();
  if (z.size() == 2 && positive[0] && positive[1]) {
    const double rho = covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1));
    return std::log(4.0 * bivariate_normal_cdf(z[0], z[1], rho));
  }
  double sum = 0.0;
  for (Eigen::Index i = 0; i < z.size(); ++i)
    if (positive[static_cast<std::size_t>(i)]) sum += std::log(2.0) + log_normal_cdf(z[i]);
  return sum;
}

// All soils as one, for effects of one common size.
EvidenceTerms stacked(std::span<const EvidenceTerms> soils) {
  EvidenceTerms sum = soils.front();
  for (const EvidenceTerms& soil : soils.subspan(1)) {
    sum.squared_norm += soil.squared_norm;
    sum.nu += soil.nu;
    sum.b += soil.b;
    sum.g += soil.g;
  }
  return sum;
}

double pooled_log_evidence(std::span<const EvidenceTerms> soils, const Explanation& explanation,
                           const std::vector<CandidateEffect>& candidates) {
  const auto sum = [&](const Explanation& e) {
    double logs = 0.0;
    for (const EvidenceTerms& soil : soils) logs += log_evidence(soil, e, candidates);
    return logs;
  };
  const bool common = !explanation.effects.empty() &&
                      std::ranges::all_of(explanation.effects,
                                          [&](std::size_t k) { return candidates[k].common_size; });
  if (!common || soils.size() == 1) return sum(explanation);
  const EvidenceTerms all = stacked(soils);
  return sum({}) + log_evidence(all, explanation, candidates) - log_evidence(all, {}, candidates);
}

// Every explanation with the logarithm of its prior probability.
std::vector<Explanation> explanations_with_priors(const std::vector<std::size_t>& effects) {
  const auto num = static_cast<double>(effects.size());
  std::vector<Explanation> all = {{{}, false, std::log(prior_none), 0.0},
                                  {{}, true, std::log(prior_other), 0.0}};
  for (std::size_t i = 0; i < effects.size(); ++i) {
    all.push_back({{effects[i]}, false, std::log(prior_singles / num), 0.0});
    for (std::size_t j = 0; j < i; ++j)
      all.push_back({{effects[j], effects[i]},
                     false,
                     std::log(2.0 * prior_pairs / (num * (num - 1.0))),
                     0.0});
  }
  return all;
}

std::vector<std::size_t> measurable_somewhere(std::span<const EvidenceTerms> soils) {
  std::vector<std::size_t> effects;
  for (Eigen::Index k = 0; k < soils.front().b.size(); ++k)
    if (std::ranges::any_of(soils, [k](const EvidenceTerms& s) { return s.g(k, k) > 0.0; }))
      effects.push_back(static_cast<std::size_t>(k));
  return effects;
}

}  // namespace

EvidenceTerms evidence_terms(const ProjectedEvidence& evidence,
                             const std::vector<CandidateEffect>& candidates) {
  Eigen::MatrixXd d = evidence.fingerprints;
  for (Eigen::Index k = 0; k < d.cols(); ++k)
    d.col(k) *= evidence.is_measurable(k) ? candidates[static_cast<std::size_t>(k)].typical : 0.0;
  return {evidence.u.squaredNorm(), static_cast<double>(evidence.nu()), d.transpose() * evidence.u,
          d.transpose() * d};
}

double log_evidence(const EvidenceTerms& terms, const Explanation& explanation,
                    const std::vector<CandidateEffect>& candidates) {
  if (explanation.other) return log_evidence_of_other(terms);
  if (explanation.effects.empty()) return log_student(terms.squared_norm, terms.nu, 1.0);
  const std::vector<Eigen::Index> a = columns_of(explanation);
  const Eigen::Index size = static_cast<Eigen::Index>(a.size());
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(size, size) + terms.g(a, a);
  const Eigen::MatrixXd covariance = precision.inverse();  // 1 x 1 or 2 x 2, condition <= 1 + tr G
  const Eigen::VectorXd b = terms.b(a);
  const Eigen::VectorXd mean = covariance * b;
  const double q = std::max(0.0, terms.squared_norm - b.dot(mean));
  std::vector<bool> positive;
  for (const std::size_t k : explanation.effects)
    positive.push_back(candidates[k].sign == EffectSign::positive);
  return -0.5 * std::log(precision.determinant()) + log_student(q, terms.nu, 1.0) +
         log_sign_ratio(mean, std::max(1.0, q / terms.nu) * covariance, positive);
}

Posterior posterior(std::span<const EvidenceTerms> soils,
                    const std::vector<CandidateEffect>& candidates) {
  Posterior result;
  result.explanations = explanations_with_priors(measurable_somewhere(soils));
  std::vector<double> logs;
  for (Explanation& e : result.explanations) {
    const double log_prior = e.log_evidence;
    e.log_evidence = pooled_log_evidence(soils, e, candidates);
    logs.push_back(log_prior + e.log_evidence);
  }
  const double total = log_sum(logs);
  result.inclusion = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t i = 0; i < logs.size(); ++i) {
    Explanation& e = result.explanations[i];
    e.probability = std::exp(logs[i] - total);
    for (const std::size_t k : e.effects)
      result.inclusion[static_cast<Eigen::Index>(k)] += e.probability;
    if (e.effects.empty()) (e.other ? result.other : result.none) = e.probability;
  }
  std::ranges::stable_sort(result.explanations, std::ranges::greater{}, &Explanation::probability);
  return result;
}

CredibleSet credible_set(const Posterior& posterior, double probability) {
  std::vector<const Explanation*> open;
  for (const Explanation& e : posterior.explanations) open.push_back(&e);
  const auto num_effects = static_cast<std::size_t>(posterior.inclusion.size());
  const std::size_t none = num_effects;
  const std::size_t other = num_effects + 1;
  CredibleSet set;
  while (set.probability < probability && !open.empty()) {
    std::vector<double> covered(num_effects + 2, 0.0);
    for (const Explanation* e : open) {
      for (const std::size_t k : e->effects) covered[k] += e->probability;
      if (e->effects.empty()) covered[e->other ? other : none] += e->probability;
    }
    const auto best = static_cast<std::size_t>(std::ranges::max_element(covered) - covered.begin());
    set.probability += covered[best];
    if (best < num_effects) set.effects.push_back(best);
    set.none |= best == none;
    set.other |= best == other;
    std::erase_if(open, [&](const Explanation* e) {
      return e->effects.empty() ? best == (e->other ? other : none)
                                : std::ranges::find(e->effects, best) != e->effects.end();
    });
  }
  return set;
}

}  // namespace tilth
