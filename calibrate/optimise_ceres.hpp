// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Bounded nonlinear least squares with a given Jacobian, with no solver type in sight.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace tilth {

/// minimise 1/2 |r(x)|^2 over lower <= x <= upper.
struct LeastSquaresProblem {
  Eigen::VectorXd lower;  ///< finite or minus infinity
  Eigen::VectorXd upper;  ///< finite or infinity
  int num_residuals = 0;
  /// Writes r (num_residuals) and, if jacobian is not null, dr/dx (num_residuals, n).
  /// False = cannot be evaluated here: the solver backs off toward the last good point.
  std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& residuals,
                     Eigen::MatrixXd* jacobian)>
      evaluate;
};

/// Stopping rules. The defaults suit noisy simulators; smooth formulas want 1e-12 or less.
struct LeastSquaresOptions {
  int max_iterations = 50;
  double absolute_tolerance = 0.0;    ///< a successful step lowers |r|^2 by less than this; 0 = off
  double function_tolerance = 1e-6;   ///< |change of cost| < this * cost
  double parameter_tolerance = 1e-6;  ///< |step| <= this * (|x| + this)
  double gradient_tolerance = 1e-10;  ///< largest projected gradient component
  /// A trial nearer than this (largest coordinate difference) to the point its step starts from is not
  /// evaluated: the search has converged. For functions with noise, which would reject ever shorter
  /// steps one by one. 0 = off.
  double least_step = 0.0;
  std::function<bool()> should_stop;  ///< asked after every iteration; may be empty
};

struct LeastSquaresResult {
  Eigen::VectorXd x;            ///< the best point; the start if nothing better was found
  double sum_of_squares = 0.0;  ///< |r(x)|^2; NaN if the start could not be evaluated
  double sum_of_squares_start = 0.0;
  bool usable = false;          ///< the start could be evaluated: x is at least as good
  bool converged = false;       ///< one of the tolerances was met
  int num_iterations = 0;       ///< successful steps
  std::vector<double> history;  ///< |r|^2 after every successful step, start first
  std::string message;
};

/// Levenberg-Marquardt (trust region, dense QR) on one thread. The Jacobian is asked for at the
/// start (twice) and after every successful step, never on trial points. A parameter at a bound
/// that descent would push outside is held while the others step.
/// @pre lower <= start <= upper
/// @throws what problem.evaluate throws
/// @source Ceres Solver 2.1 manual; bounds by projection, Kanzow, Yamashita & Fukushima 2004,
///         and Bertsekas, SIAM J. Control Optim. 20 (1982) 221
LeastSquaresResult minimise_with_ceres(const LeastSquaresProblem& problem,
                                       const Eigen::VectorXd& start,
                                       const LeastSquaresOptions& options);

}  // namespace tilth
