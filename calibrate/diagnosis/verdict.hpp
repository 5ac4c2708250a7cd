// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The answer: what is missing, or why that cannot be said.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/diagnosis/gap_detection.hpp"
#include "calibrate/diagnosis/naming_support.hpp"

namespace tilth {

enum class Verdict {
  none,               ///< no gap larger than noise, and effects of interest would have been seen
  named,              ///< posterior above 0.8, at least two experiments, stable, nothing left over
  suggested,          ///< a name that rests on one kind of experiment
  set,                ///< one of several effects; these data cannot tell which
  outside_catalogue,  ///< a gap that no candidate describes
  inconclusive        ///< nothing found, and nothing could have been seen
};
std::string_view to_string(Verdict verdict);

struct DiagnosisOptions {
  int num_resamples = 200;    ///< for the naming stability; 0: not measured and not demanded
  int num_repetitions = 400;  ///< parametric bootstrap of X2 and the largest score; 0: not made
  std::uint64_t seed = 1;
};

struct NamedEffect {
  std::size_t effect = 0;  ///< position in the catalogue
  std::string id;
  double posterior = 0.0;              ///< inclusion probability
  double stability = 0.0;              ///< NaN if not measured
  int num_supporting_experiments = 0;  ///< 1: the verdict is `suggested`
  std::vector<EffectSize> sizes;       ///< one per soil
};

/// Detection and scores of one soil.
struct SoilDiagnosis {
  std::string soil;
  GlobalGap gap;
  double bootstrap_tail = 1.0;      ///< of X2; NaN if no repetitions were made
  std::vector<EffectScore> scores;  ///< (K)
  Eigen::VectorXd adjusted_tails;   ///< (K) of the largest score, Westfall-Young; empty if not made
  Eigen::MatrixXd look_alikes;      ///< (K, K)
};

struct Diagnosis {
  Verdict verdict = Verdict::inconclusive;
  std::string reason = "diagnose() was not called";  ///< one plain sentence
  std::vector<NamedEffect> effects;                  ///< of named and suggested: one or two
  std::vector<std::string> set;  ///< ids, most probable first: the credible set of effects
  bool set_holds_none = false;   ///< "nothing" belongs to the credible set
  bool set_holds_other = false;  ///< "something else" belongs to the credible set
  Posterior posterior;
  NamingStability stability;
  GlobalGap gap_before;  ///< all soils
  GlobalGap gap_after;   ///< with the effects above the naming probability absorbed
  std::vector<SoilDiagnosis> soils;
};

/// The decision for one soil or several pooled.
///
/// 1. An effect whose posterior inclusion exceeds 0.8 is a name (at most two).
/// 2. A name that leads in less than 80 % of resamples becomes a set, with all that led in 5 %.
/// 3. If X2 after adding the names still has a tail below 5 %: outside the catalogue. V then
/// includes
///    the packing noise of the named fingerprints, times the squared size.
/// 4. A name that rests on one experiment (num_supporting_experiments) is `suggested`.
/// 5. Without a name the most probable of {nothing, other, effects} decides between `none`,
///    `outside_catalogue` and `set`. `none` becomes `inconclusive` if no candidate of interest had
///    a power of 80 %, or if X2 is beyond noise (tail below 1 %) although nothing explains it.
///
/// Too few data are an answer, not an error: with no statistic left after the baseline's
/// parameters, or no measurable effect, the verdict is `inconclusive` with the reason.
/// @pre at least one soil; all with the same candidates in the same order
/// @throws std::invalid_argument where shapes disagree or numbers are not finite
Diagnosis diagnose(std::span<const SoilEvidence> soils, const DiagnosisOptions& options);

}  // namespace tilth
