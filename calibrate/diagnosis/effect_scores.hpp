// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Score of every effect: how strongly the residual asks for it, how large it would be, and whether
// the data could have seen it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/diagnosis/projection.hpp"

namespace tilth {

enum class EffectSign {
  positive,  ///< the effect can only be >= 0
  free,      ///< either sign (an offset)
};

/// A candidate as the statistics need it. Sizes are in the effect's own unit.
struct CandidateEffect {
  std::string id;
  EffectSign sign = EffectSign::positive;
  double typical = 1.0;      ///< tau_k > 0: scale of the half-normal prior of its size
  double of_interest = 1.0;  ///< delta_k > 0: smallest size worth adding to the model
  bool common_size = false;  ///< one size in all soils (a rig's artefact), else one per soil
};

/// Saris, Satorra & van der Veld, Struct. Equ. Modeling 16 (2009) 561, table 2 (as in lavaan).
enum class EffectDecision {
  inconclusive,   ///< not significant, power low: could not have been seen
  misspecified,   ///< significant with low power, or significant and larger than of_interest
  absent,         ///< not significant with high power, or significant but smaller than of_interest
  not_measurable  ///< no fingerprint above its own packing noise: excluded from naming
};
std::string_view to_string(EffectDecision decision);

struct EffectScore {
  double z = 0.0;                   ///< t' r_w / |t|, N(0, 1) if nothing is missing
  double modification_index = 0.0;  ///< z^2: predicted drop of chi-square; 0 for a forbidden sign
  double expected_change = 0.0;     ///< t' r_w / |t|^2, one-step estimate of the size
  double standard_error = 0.0;      ///< 1 / |t|
  double power = 0.0;               ///< to see of_interest at test_level
  double smallest_visible = 0.0;    ///< size seen with a power of 80 %
  double kept = 0.0;                ///< share of the fingerprint that a refit cannot imitate
  bool opposite = false;  ///< positive effect, significantly negative z: look for the opposite
  EffectDecision decision = EffectDecision::not_measurable;
};

/// Probability that a one-sided (positive) or two-sided (free) test of level `level` rejects when
/// z ~ N(shift, 1).
double test_power(double shift, EffectSign sign, double level);

/// Scores of all candidates, in their order; those not measurable keep NaN numbers except `kept`.
/// @pre candidates.size() == evidence.fingerprints.cols()
/// @source score test: Rao 1948; modification index and expected change: lavaan, lav_modification;
///         one-sided: max(0, z)^2 is half 0, half chi-square of 1 (Self & Liang 1987)
std::vector<EffectScore> effect_scores(const ProjectedEvidence& evidence,
                                       const std::vector<CandidateEffect>& candidates);

/// z_k of all fingerprints (0 where not measurable).
Eigen::VectorXd signed_scores(const ProjectedEvidence& evidence);

/// The score in the direction an effect may have: z, or |z| for a free sign.
double directed_score(double z, EffectSign sign);

/// F(1, nu - 1) of one effect where the scale of V is not known: MI / ((X2 - MI) / (nu - 1)).
/// @pre nu > 1, X2 > MI
double scale_free_f(double modification_index, double chi_square, Eigen::Index nu);

}  // namespace tilth
