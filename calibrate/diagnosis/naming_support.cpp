// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/naming_support.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "calibrate/diagnosis/thresholds.hpp"
#include "calibrate/student_t.hpp"

namespace tilth {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

using Names = std::set<std::string>;

// Score of one effect in one soil after striking out experiments: their whitened rows become free,
// so their directions in the space of u are projected out.
struct RestScore {
  double product = 0.0;       // t' r_w
  double squared_norm = 0.0;  // |t|^2
};

RestScore rest_score(const ProjectedEvidence& soil, Eigen::Index effect, const Names& struck) {
  Eigen::VectorXd f = soil.fingerprints.col(effect);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < soil.experiments.size(); ++i)
    if (struck.contains(soil.experiments[i])) rows.push_back(static_cast<Eigen::Index>(i));
  if (!rows.empty()) {
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> freed(
        soil.basis(rows, Eigen::all).transpose());
    const double before = f.squaredNorm();
    f -= soil.basis(rows, Eigen::all).transpose() * freed.solve(f);
    if (f.squaredNorm() < 1e-12 * before) return {};  // rounding
  }
  return {f.dot(soil.u), f.squaredNorm()};
}

double rest_score(std::span<const ProjectedEvidence> soils, Eigen::Index effect, EffectSign sign,
                  const std::vector<double>& typical, const Names& struck) {
  RestScore sum;
  for (std::size_t s = 0; s < soils.size(); ++s) {
    if (!soils[s].is_measurable(effect)) continue;
    const RestScore one = rest_score(soils[s], effect, struck);
    sum.product += typical[s] * one.product;
    sum.squared_norm += typical[s] * typical[s] * one.squared_norm;
  }
  return sum.squared_norm > 0.0 ? directed_score(sum.product / std::sqrt(sum.squared_norm), sign)
                                : 0.0;
}

std::vector<EffectSize> joint_sizes(const Eigen::MatrixXd& information, const Eigen::VectorXd& b,
                                    double squared_norm, double nu,
                                    const std::vector<EffectSign>& signs) {
  const Eigen::MatrixXd covariance = information.inverse();
  const Eigen::VectorXd value = covariance * b;
  const double freedom = nu - static_cast<double>(b.size());
  const double left = squared_norm - b.dot(value);
  const double scale = freedom > 0.0 ? std::max(1.0, left / freedom) : 1.0;
  const double t =
      student_t_half_width(0.9, static_cast<int>(diagnosis_thresholds::evidence_freedom));
  std::vector<EffectSize> sizes;
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    const double error = std::sqrt(scale * covariance(i, i));
    const double least = signs[static_cast<std::size_t>(i)] == EffectSign::positive
                             ? 0.0
                             : -std::numeric_limits<double>::infinity();
    sizes.push_back({value[i], error, std::max(least, value[i] - t * error),
                     std::max(least, value[i] + t * error)});
  }
  return sizes;
}

// Which of none (K), other (K + 1) and the effects (0 ... K - 1) is most probable.
Eigen::Index leading_item(const Posterior& p) {
  Eigen::VectorXd items(p.inclusion.size() + 2);
  items << p.inclusion, p.none, p.other;
  Eigen::Index best = 0;
  items.maxCoeff(&best);
  return best;
}

}  // namespace

int num_supporting_experiments(std::span<const ProjectedEvidence> soils, Eigen::Index effect,
                               EffectSign sign, const std::vector<double>& typical) {
  Names left;
  for (const ProjectedEvidence& soil : soils)
    left.insert(soil.experiments.begin(), soil.experiments.end());
  left.erase("");
  Names struck;
  while (!left.empty() &&
         rest_score(soils, effect, sign, typical, struck) > diagnosis_thresholds::support_score) {
    const auto score_without = [&](const std::string& experiment) {
      Names more = struck;
      more.insert(experiment);
      return rest_score(soils, effect, sign, typical, more);
    };
    const auto weakest = std::ranges::min_element(left, {}, score_without);
    struck.insert(*weakest);
    left.erase(weakest);
  }
  return static_cast<int>(struck.size());
}

std::vector<std::vector<EffectSize>> effect_sizes(std::span<const ProjectedEvidence> soils,
                                                  const std::vector<CandidateEffect>& candidates,
                                                  const std::vector<std::size_t>& effects) {
  const bool common =
      std::ranges::all_of(effects, [&](std::size_t k) { return candidates[k].common_size; });
  std::vector<Eigen::Index> columns(effects.begin(), effects.end());
  std::vector<EffectSign> signs;
  for (const std::size_t k : effects) signs.push_back(candidates[k].sign);
  const auto size = static_cast<Eigen::Index>(effects.size());
  Eigen::MatrixXd all_g = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd all_b = Eigen::VectorXd::Zero(size);
  double all_norm = 0.0;
  double all_nu = 0.0;
  std::vector<std::vector<EffectSize>> result;
  for (const ProjectedEvidence& soil : soils) {
    const Eigen::MatrixXd f = soil.fingerprints(Eigen::all, columns);
    const bool measurable =
        std::ranges::all_of(columns, [&](Eigen::Index k) { return soil.is_measurable(k); });
    all_g += f.transpose() * f;
    all_b += f.transpose() * soil.u;
    all_norm += soil.u.squaredNorm();
    all_nu += static_cast<double>(soil.nu());
    result.push_back(measurable
                         ? joint_sizes(f.transpose() * f, f.transpose() * soil.u,
                                       soil.u.squaredNorm(), static_cast<double>(soil.nu()), signs)
                         : std::vector<EffectSize>(effects.size(),
                                                   {nan_value, nan_value, nan_value, nan_value}));
  }
  if (common && !effects.empty())
    std::ranges::fill(result, joint_sizes(all_g, all_b, all_norm, all_nu, signs));
  return result;
}

NamingStability naming_stability(std::span<const SoilEvidence> soils, int num_resamples,
                                 std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  const auto num_effects = static_cast<Eigen::Index>(soils.front().candidates.size());
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(num_effects + 2);
  for (int i = 0; i < num_resamples; ++i) {
    std::vector<EvidenceTerms> terms;
    for (const SoilEvidence& soil : soils)
      terms.push_back(
          evidence_terms(analysed(soil, resampled(soil.samples, rng)).projected, soil.candidates));
    counts[leading_item(posterior(terms, soils.front().candidates))] += 1.0;
  }
  counts /= std::max(1, num_resamples);
  return {num_resamples, counts.head(num_effects), counts[num_effects], counts[num_effects + 1]};
}

}  // namespace tilth
