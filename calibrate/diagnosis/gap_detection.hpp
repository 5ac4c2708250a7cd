// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Is there a gap at all? Chi-square of what the baseline cannot absorb, the largest score, decoys.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "calibrate/diagnosis/soil_evidence.hpp"

namespace tilth {

/// X2 = |M r_w|^2, chi-square with nu degrees of freedom if nothing is missing and V is known.
struct GlobalGap {
  double chi_square = 0.0;
  double nu = 0.0;
  double tail_probability = 1.0;  ///< P(F(nu, 30) > X2 / nu): V is estimated
};

GlobalGap global_gap(const ProjectedEvidence& evidence);

/// The same after the given effects, with sizes free, were added to the baseline.
GlobalGap gap_beyond(const ProjectedEvidence& evidence, const std::vector<Eigen::Index>& effects);

/// The evidence with some effects treated as further baseline parameters; their own fingerprints
/// become zero and are not measurable any more.
ProjectedEvidence with_absorbed(const ProjectedEvidence& evidence,
                                const std::vector<Eigen::Index>& effects);

/// Repetitions of the campaign in which nothing is missing.
struct NullRepetitions {
  Eigen::VectorXd chi_square;     ///< (num)
  Eigen::VectorXd largest_score;  ///< (num) largest directed score of all measurable effects
};

/// Parametric bootstrap: specimens and packings are drawn from a normal distribution with the
/// moderated covariance, V is estimated from them again, and the statistics are recomputed. So the
/// tails include that V is estimated, that candidates are correlated and that the largest is taken.
/// @source max statistic: Westfall & Young, Resampling-Based Multiple Testing, 1993
NullRepetitions null_repetitions(const SoilEvidence& soil, int num, std::uint64_t seed);

/// (1 + how many of `sample` are at least x) / (1 + size): never zero.
/// @source Davison & Hinkley, Bootstrap Methods and their Application, 1997, eq. 4.11
double bootstrap_tail(const Eigen::VectorXd& sample, double x);

/// Estimated share of false discoveries if all effects with a score of at least z_k were called:
/// min(1, (1 + decoys above z_k) / (effects above z_k)), scaled by effects per decoy.
///
/// A decoy is the difference of two sets of baseline packings, scaled to the typical |s_k|: it
/// looks like a fingerprint and cannot be the cause.
/// @param scores, decoys  directed scores; @return one share per effect; 1 without decoys
/// @source counting rule of target-decoy search: Elias & Gygi, Nature Methods 4 (2007) 207; the 1
///         added: Barber & Candes, Ann. Statist. 43 (2015) 2055
Eigen::VectorXd false_discovery_shares(const Eigen::VectorXd& scores,
                                       const Eigen::VectorXd& decoys);

}  // namespace tilth
