// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Profile likelihood: how far one parameter can move while all others follow.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibrate/fit_summary.hpp"
#include "calibrate/optimise_ceres.hpp"

namespace tilth {

/// 95 % point of chi-square with one degree of freedom: exp(-3.84 / 2) = 0.1465 of the likelihood.
inline constexpr double chi_square_95 = 3.841458820694126;

/// The least |r|^2 with one parameter held.
struct ProfilePoint {
  Eigen::VectorXd unit;    ///< all parameters there
  double chi_square = 0.0;
  int at_bound = -1;       ///< another parameter that its bound holds back there; -1 = none
  /// Difference that would remain at this distance from the optimum if that bound were lifted, by
  /// the derivatives here:  |M J_j|^2 (u_j - u_j,opt)^2, M = projection off the other columns.
  double if_lifted = 0.0;
};

/// Points in ascending order of the held parameter, the optimum among them. Empty if nothing could
/// be evaluated.
using Profile = std::vector<ProfilePoint>;

struct ProfileOptions {
  int num_grid = 16;  ///< evenly spaced points over the range, beside those near the optimum
  double level = chi_square_95;
  int max_iterations = 30;  ///< per point
  double function_tolerance = 1e-6;
};

/// Profile of parameter `held` over the unit interval.
///
///   chi2(u) = min over the other parameters of |r|^2 with u_held = u, all in [0, 1]
///
/// Points: even ones over the range; near the optimum at 0.5, 1, 1.5, 2 and 3 standard errors; then
/// the crossings of the level are closed in on. Walks away from the optimum on both sides, starting
/// each fit from its neighbour's end, or from the best candidate nearby if that is lower.
/// @param standard_error  of `held` in the unit cube; NaN if not known
/// @param candidates      points of the cube to restart from, one per column; may have no columns
/// @pre optimum is (nearly) the minimum of |r|^2 in the unit cube
/// @source Raue et al., Bioinformatics 25 (2009) 1923
Profile draw_profile(const LeastSquaresProblem& problem, const Eigen::VectorXd& optimum, int held,
                     double standard_error, const Eigen::MatrixXd& candidates,
                     const ProfileOptions& options);

struct ProfileReading {
  ParameterVerdict verdict = ParameterVerdict::unknown;
  int limited_by = -1;      ///< of bound_limited
  double low = not_known;   ///< unit coordinate where the level is crossed; NaN where it is not
  double high = not_known;
};

/// Verdict of a profile.
///
///   multimodal      beyond a crossing of the level the profile comes back below it
///   bound_limited   on a side where it is crossed another parameter is at its bound, and lifting
///                   that bound would leave less than a quarter of the level at this distance: the
///                   interval would be more than twice as long
///   identified, one_sided, flat   crossed on two, one, no sides
///
/// Crossings are interpolated in the square root of the difference, which is straight for a linear
/// model.
/// @param least  the least chi-square known; differences are taken from it
ProfileReading read_profile(const Profile& profile, int held, double least, double level);

}  // namespace tilth
