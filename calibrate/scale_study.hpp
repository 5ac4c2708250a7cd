// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// How much an answer changes with particle size, and up to which size that may be borne.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tilth {

/// What one particle size answered on several packings.
struct SizeAnswers {
  double radius_m = 0.0;
  std::vector<Eigen::VectorXd> displacement_m;  ///< one vector per packing, the same quantities in each
};

/// Difference of one size from the finest, as a share of the finest's displacement.
struct Dissimilarity {
  double radius_m = 0.0;
  double raw = 0.0;         ///< |u - u_finest| / |u_finest| of the means: holds the packings' scatter too
  double scatter = 0.0;     ///< what raw would be for equal true means
  double share = 0.0;       ///< sqrt of the square without scatter, 0 where that is negative
  double lo95 = 0.0, hi95 = 0.0;  ///< of share
};

/// How the search for the limit ended.
enum class ScaleVerdict {
  found,       ///< growth with size is significant: a limit with an interval
  all_within,  ///< no significant growth, and the largest size keeps the tolerance at 95 %
  undecided,   ///< no significant growth, but the packings' scatter could hide one beyond the tolerance
};

const char* name_of(ScaleVerdict verdict);

/// The largest radius that keeps the displacement within the tolerance of the finest size's.
struct ScaleLimit {
  ScaleVerdict verdict = ScaleVerdict::undecided;
  double tolerance = 0.0;
  double radius_m = 0.0;            ///< NaN unless found
  double lo95_m = 0.0;              ///< every size up to here keeps the tolerance at 95 %
  std::optional<double> hi95_m;     ///< none: open above
  double slope_squared_per_m2 = 0.0;   ///< s^2 of share = s (radius - finest); its estimate may be negative
  double slope_squared_error = 0.0;
  double misfit = 0.0;              ///< chi-square of that line over sizes - 2 degrees of freedom, NaN for two sizes
};

struct ScaleStudy {
  std::vector<Dissimilarity> sizes;  ///< finest first; the finest's own share is 0
  ScaleLimit limit;
};

/// Compares every size with the finest.
///
/// With means u over n packings, finest f, S the covariance of one packing's answer, pooled over sizes:
///   D^2 = (|u_r - u_f|^2 - tr S (1/n_r + 1/n_f)) / (|u_f|^2 - tr S / n_f)
/// whose numerator has the mean |b|^2, b the true difference. The covariance of two of them, Gaussian scatter:
///   2 tr(S^2) c_rs^2 + 4 b_r'S b_s c_rs,  c_rs = 1/n_f (+ 1/n_r if r = s)
/// Products of deviations e of *different* sizes are independent, E (e_i'e_j)^2 = tr(S^2) (1 - 1/n_i)(1 - 1/n_j):
/// they give tr(S^2); b'Sb from the deviations along b, less what scatter adds to it. The error of |u_f|, of
/// first order smaller, is left out. Intervals are standard errors of D^2 times Student's t for the sum of n - 1.
///
/// The limit comes from the line D = s (radius - finest), an error of first order in the size as a layer one
/// grain thick makes it: s^2 by least squares weighted with the variances at the fitted line, its error from the
/// whole covariance; limit = finest + tolerance / s.
/// @param tolerance share, in (0, 1)
/// @throws std::invalid_argument for fewer than two sizes, equal radii, fewer than two packings of any size, or
///         vectors of different length
ScaleStudy study_scale(std::span<const SizeAnswers> sizes, double tolerance);

/// A number per size and packing and what it is at the finest size: draught, contact density.
struct Drift {
  double radius_m = 0.0;
  double mean = 0.0, sd = 0.0;   ///< over packings; sd NaN for one
  double over_finest = 0.0;      ///< ratio of means
  double over_finest_error = 0.0;  ///< standard error, first order
};

/// Finest first. @param values one list of packings per size, in the order of radii
std::vector<Drift> drift_of(std::span<const double> radii_m, std::span<const std::vector<double>> values);

}  // namespace tilth
