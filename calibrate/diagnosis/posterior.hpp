// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Probability of every explanation: nothing, one effect, two effects, something else.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "calibrate/diagnosis/effect_scores.hpp"

namespace tilth {

/// What the posterior needs of one soil, with effects in units of their typical size tau:
/// D = [tau_k f_k], b = D'u, G = D'D. Effects that are not measurable have zeros: adding them
/// changes nothing in this soil.
struct EvidenceTerms {
  double squared_norm = 0.0;  ///< u'u
  double nu = 0.0;
  Eigen::VectorXd b;  ///< (K)
  Eigen::MatrixXd g;  ///< (K, K)
};

EvidenceTerms evidence_terms(const ProjectedEvidence& evidence,
                             const std::vector<CandidateEffect>& candidates);

/// One explanation of the residual. No effect and not `other`: nothing is missing.
struct Explanation {
  std::vector<std::size_t> effects;  ///< none, one or two positions in the catalogue, ascending
  bool other = false;                ///< a discrepancy that no candidate describes
  double log_evidence = 0.0;         ///< up to a constant common to all explanations
  double probability = 0.0;
};

struct Posterior {
  std::vector<Explanation> explanations;  ///< most probable first
  double none = 0.0;
  double other = 0.0;
  Eigen::VectorXd inclusion;  ///< (K) sum over the explanations that contain the effect
};

/// log p(u | explanation) of one soil.
///
///   alpha_k / tau_k ~ half-normal(0, 1) (normal for a free sign),
///   Q_A = u'u - b_A' (I + G_AA)^-1 b_A
///   log ev_A = -log det(I + G_AA) / 2 - (df + nu) log(1 + Q_A / df) / 2 + log P(sign)
///
/// P(sign) is the ratio of the posterior to the prior probability of the permitted signs, the
/// posterior being normal with mean (I + G_AA)^-1 b_A and covariance max(1, Q_A / nu) (I +
/// G_AA)^-1. "Other" is u ~ t(0, (1 + g) I), its evidence averaged over g = 0.3, 0.7, 1.5, 3, 6,
/// 12: a discrepancy in all directions the baseline cannot absorb.
/// @source design of this project, docs/theory/diagnosis.md; normal linear model with unit
///         information prior in closed form: O'Hagan & Forster, Bayesian Inference, 2004, chapter
///         11
double log_evidence(const EvidenceTerms& terms, const Explanation& explanation,
                    const std::vector<CandidateEffect>& candidates);

/// Posterior over nothing (prior 0.4), each measurable effect (0.4 together), each pair of them
/// (0.1 together) and other (0.1).
///
/// Over several soils evidences multiply: an effect has a size of its own in every soil, except
/// that explanations made of `common_size` effects alone have one size in all.
/// @pre at least one soil; all with the same effects in the same order
/// @cost O(soils * K^2)
Posterior posterior(std::span<const EvidenceTerms> soils,
                    const std::vector<CandidateEffect>& candidates);

/// The smallest set of explanations {nothing, effects, other} that holds the truth with
/// `probability`. A pair is covered by either of its effects: "at least one of these".
struct CredibleSet {
  std::vector<std::size_t> effects;  ///< most probable first
  bool none = false;
  bool other = false;
  double probability = 0.0;
  std::size_t size() const { return effects.size() + (none ? 1 : 0) + (other ? 1 : 0); }
};

/// Greedy: again and again the item that covers most of what is not yet covered.
CredibleSet credible_set(const Posterior& posterior, double probability);

}  // namespace tilth
