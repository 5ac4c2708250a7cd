// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The searches that are compared, each counted in simulations of one parameter set on one packing.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "bench/search/stand_in.hpp"
#include "calibrate/fit_options.hpp"
#include "calibrate/optimise_nlopt.hpp"

namespace tilth::bench {

/// The floor: noise-free chi-square above its least. Errors of the data and of one simulation put
/// the truth itself chi^2 of num_free degrees above the least, num_free on average: a set within it
/// cannot be told from the truth.
inline constexpr double noise_floor = 3.0;
inline constexpr double strict_floor = 1.0;  ///< one standard error of one parameter

/// Simulations after which the best point so far was first inside. "Best" is by the method's own
/// noisy chi-square; only then is the noise-free one looked at. Empty: never within the cap.
struct Outcome {
  std::optional<std::size_t> to_floor;
  std::optional<std::size_t> to_strict_floor;
  /// The same in calls: what is asked for at once, and so can run side by side, is one call.
  std::optional<std::size_t> calls_to_floor;
  std::size_t num_calls = 0;
  std::size_t num_simulations = 0;   ///< when the method ended, or was ended
  double excess_returned = not_set;  ///< of the point that fit() returned, above the least
  static constexpr double not_set = -1.0;
};

/// What the plain searches minimise: chi-square of the mean over num_packings packings, the same
/// for all points. They restart at a new random point when they stop, until the strict floor or
/// the cap; the first start is that of run_fit().
Outcome run_nlopt(const StandIn& stand_in, const Twin& twin, NloptAlgorithm algorithm,
                  int num_packings);

/// Levenberg-Marquardt with forward differences. @param step  share of the unit interval
Outcome run_ceres(const StandIn& stand_in, const Twin& twin, double step, int num_packings);

/// fit(), without confirming simulator and hold-outs. While it works on one packing, its best point
/// is the best one there; once a point of the local search is complete on all search packings,
/// the best of the complete ones.
Outcome run_fit(const StandIn& stand_in, const Twin& twin, FitOptions options);

}  // namespace tilth::bench
