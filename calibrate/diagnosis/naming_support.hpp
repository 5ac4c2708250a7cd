// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What stands behind a name: independent experiments, its size, and whether resampled data agree.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "calibrate/diagnosis/posterior.hpp"
#include "calibrate/diagnosis/soil_evidence.hpp"

namespace tilth {

/// How many experiments would have to be wrong to leave no evidence for an effect.
///
/// Experiments are struck out, rows and all, in all soils, each time the one without which the
/// score
///
///   z_rest = sum_s t_s' r_s / sqrt(sum_s |t_s|^2)     (sums over soils, of the experiments left)
///
/// is least, until z_rest falls below 1.645. The count of strikes is the result: 0 if there is no
/// evidence at all, 1 if the name does not survive an arbitrary error of one rig. An effect that
/// moves one rig only is always 0 or 1. Priors are no experiment.
/// @param soils, typical  projected evidence and size of the effect in each soil
/// @source own construction, docs/theory/diagnosis.md
int num_supporting_experiments(std::span<const ProjectedEvidence> soils, Eigen::Index effect,
                               EffectSign sign, const std::vector<double>& typical);

/// Size of one effect in one soil, jointly with the others that are named.
struct EffectSize {
  double value = 0.0;             ///< generalised least squares
  double standard_error = 0.0;    ///< scaled by max(1, X2_left / nu_left)
  double lo90 = 0.0, hi90 = 0.0;  ///< Student t with 30 degrees; not below 0 for a positive effect
};

/// Sizes of `effects` in every soil: result[s][i]. Effects of one common size get the same in all,
/// if all named effects are such. NaN where an effect cannot be measured in a soil.
std::vector<std::vector<EffectSize>> effect_sizes(std::span<const ProjectedEvidence> soils,
                                                  const std::vector<CandidateEffect>& candidates,
                                                  const std::vector<std::size_t>& effects);

/// Shares of resamples in which an effect, nothing or other is the most probable.
struct NamingStability {
  int num_resamples = 0;
  Eigen::VectorXd leading;  ///< (K)
  double none = 0.0;
  double other = 0.0;
};

/// Specimens and packings are drawn with replacement within every test, V, residual and posterior
/// made anew. A resample carries its own noise on top of that of the data, so the leading effect is
/// counted, not whether it passes the naming threshold once more.
/// @source bootstrap: Efron & Tibshirani 1993, chapter 6
NamingStability naming_stability(std::span<const SoilEvidence> soils, int num_resamples,
                                 std::uint64_t seed);

}  // namespace tilth
