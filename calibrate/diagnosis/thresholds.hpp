// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Every fixed number of the diagnosis, in one place.
//
// Priors, degrees of freedom and thresholds were set once on the development batch of the linear
// toy (docs/theory/diagnosis.md) and are not changed for particular cases, soils or codes.
#pragma once

namespace tilth::diagnosis_thresholds {

/// @name Posterior over {nothing, one effect, two effects, other}
///@{
inline constexpr double prior_none = 0.4;
inline constexpr double prior_singles = 0.4;  ///< shared equally by the effects
inline constexpr double prior_pairs = 0.1;    ///< shared equally by the pairs
inline constexpr double prior_other = 0.1;
inline constexpr double evidence_freedom = 30.0;  ///< of Student's t: V is estimated, not known
///@}

inline constexpr double name_probability = 0.8;    ///< above: the effect is named
inline constexpr double set_probability = 0.95;    ///< the smallest set that reaches it is printed
inline constexpr double least_stability = 0.8;     ///< share of resamples that agree with the name
inline constexpr double gap_level = 0.01;          ///< X2 tail: a gap is certain
inline constexpr double residual_level = 0.05;     ///< X2 tail after naming: the name is not enough
inline constexpr double test_level = 0.05;         ///< of one effect in the decision table
inline constexpr double high_power = 0.8;          ///< Saris & Satorra: power counts as high
inline constexpr double support_score = 1.645;     ///< one-sided 5 %: what is left is evidence
inline constexpr double measurable_ratio = 4.0;    ///< |t|^2 over its own seed noise
inline constexpr double separable_lambda = 5.411;  ///< 2 * 1.645^2: 95 % correct ordering

inline constexpr double moderation_freedom = 8.0;  ///< d0: weight of pooled variances in replicates
inline constexpr double prior_correlation = 0.3;   ///< within one test, before it is measured

}  // namespace tilth::diagnosis_thresholds
