// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/gap_detection.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <limits>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/diagnosis/thresholds.hpp"

namespace tilth {

GlobalGap global_gap(const ProjectedEvidence& evidence) {
  GlobalGap gap;
  gap.chi_square = evidence.u.squaredNorm();
  gap.nu = static_cast<double>(evidence.nu());
  if (gap.nu > 0.0)
    gap.tail_probability =
        f_tail(gap.chi_square / gap.nu, gap.nu, diagnosis_thresholds::evidence_freedom);
  return gap;
}

GlobalGap gap_beyond(const ProjectedEvidence& evidence, const std::vector<Eigen::Index>& effects) {
  return global_gap(with_absorbed(evidence, effects));
}

ProjectedEvidence with_absorbed(const ProjectedEvidence& evidence,
                                const std::vector<Eigen::Index>& effects) {
  if (effects.empty()) return evidence;
  const Eigen::Index nu = evidence.nu();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(evidence.fingerprints(Eigen::all, effects));
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(nu, nu);
  const Eigen::MatrixXd left = q.rightCols(nu - qr.rank());
  ProjectedEvidence rest = evidence;
  rest.basis = evidence.basis * left;
  rest.u = left.transpose() * evidence.u;
  rest.fingerprints = left.transpose() * evidence.fingerprints;
  rest.fingerprints(Eigen::all, effects).setZero();
  for (Eigen::Index k = 0; k < rest.kept.size(); ++k) {
    const double before = evidence.fingerprints.col(k).squaredNorm();
    rest.kept[k] *= before > 0.0 ? rest.fingerprints.col(k).squaredNorm() / before : 0.0;
  }
  return rest;
}

NullRepetitions null_repetitions(const SoilEvidence& soil, int num, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  NullRepetitions result{Eigen::VectorXd(num), Eigen::VectorXd(num)};
  for (int i = 0; i < num; ++i) {
    const ProjectedEvidence drawn =
        analysed(soil, drawn_samples(soil.samples, soil.noise, rng)).projected;
    result.chi_square[i] = drawn.u.squaredNorm();
    const Eigen::VectorXd z = signed_scores(drawn);
    double largest = -std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < z.size(); ++k)
      largest = std::max(largest,
                         directed_score(z[k], soil.candidates[static_cast<std::size_t>(k)].sign));
    result.largest_score[i] = largest;
  }
  return result;
}

double bootstrap_tail(const Eigen::VectorXd& sample, double x) {
  return (1.0 + static_cast<double>((sample.array() >= x).count())) /
         (1.0 + static_cast<double>(sample.size()));
}

Eigen::VectorXd false_discovery_shares(const Eigen::VectorXd& scores,
                                       const Eigen::VectorXd& decoys) {
  if (decoys.size() == 0) return Eigen::VectorXd::Ones(scores.size());
  const double per_decoy = static_cast<double>(scores.size()) / static_cast<double>(decoys.size());
  return scores.unaryExpr([&](double z) {
    const auto false_calls = static_cast<double>((decoys.array() >= z).count());
    const auto calls = static_cast<double>((scores.array() >= z).count());
    return std::min(1.0, (1.0 + false_calls) * per_decoy / calls);
  });
}

}  // namespace tilth
