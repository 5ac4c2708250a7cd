// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Fits parameters of any simulator to targets, and says how well they are known.
#pragma once

#include <vector>

#include "calibrate/fit_options.hpp"
#include "calibrate/fit_summary.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/simulator.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// Weighted least squares of a noisy, failing, expensive simulator.
///
///   minimise  chi^2 = sum_k [(m_k + b_k - T(value_k)) / sigma_total_k]^2
///                     + sum_j [(c_j - prior_mean_j) / prior_sigma_j]^2,
///   m_k = mean over the search seeds of T(feature_k), b_k = bias of the search model
///
/// Stages: Sobol design and reachability; seed noise at its best point; emulator-assisted global
/// search; Levenberg-Marquardt with paired secants from several starts; bias against `confirm`
/// and refit; uncertainty; fresh seeds and hold-outs. Hold-out values enter none but the last.
/// A failed run is left out and recorded; non-convergence is a value. Same arguments, same bits.
///
/// Limits: intervals are linear (normal, absolute sigma) in the coordinate; the seed scatter is
/// measured at one point and taken as the same everywhere; a point counts only if all its search
/// seeds completed, since a missing packing would shift the mean.
///
/// @param search   the cheap simulator used by all stages
/// @param confirm  larger or slower runs of the same tests; null if there are none
/// @param holdout  gives the hold-outs at the end, on fresh seeds and on the secants of one of them;
///                 then the other two are asked for fitted targets only. Null: they give all.
/// @throws what a simulator throws, and std::runtime_error if it breaks its contract
FitSummary fit(const std::vector<Parameter>& parameters, const std::vector<Target>& targets,
               const Simulator& search, const Simulator* confirm, const FitOptions& options,
               const Simulator* holdout = nullptr);

}  // namespace tilth
