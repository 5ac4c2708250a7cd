// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A fitted set against data that took no part in its fit.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "calibrate/fit_options.hpp"
#include "calibrate/fit_summary.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/simulator.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

struct ValidationProblem {
  std::vector<Parameter> parameters;  ///< `start` is the fitted value; bounds, scale and `estimate` as in the fit
  Eigen::MatrixXd covariance;  ///< of the free ones, in the coordinate, as the fit gave it; empty: taken as zero
  std::vector<Target> targets;             ///< all are predicted, whatever their `holdout` says
  std::vector<std::uint64_t> seeds;        ///< packings no stage of the fit has used, at least two
  double limit = 2.0;                      ///< pass mark of the fit, written down before it
  FitOptions options;                      ///< secant steps and failure rule
  std::function<bool()> should_stop;       ///< may be empty
};

struct Validation {
  std::vector<TargetResult> targets;  ///< simulated, seed_sd, parameter_sd, sigma_total and residual are set
  double rms = not_known;             ///< root mean square residual; NaN if nothing could be predicted
  double limit = not_known;
  int num_seeds = 0;                  ///< completed packings
  bool has_parameter_errors = false;  ///< false: the runs around the fitted set failed, or no covariance
  std::size_t num_simulations = 0;
  std::vector<FailedRun> failures;
  bool stopped = false;

  bool passed() const { return rms <= limit; }
};

/// Predicts every target at the fitted values.
///
///   residual = (mean_s T(simulated) - T(value)) / sigma_total,
///   sigma_total^2 = sigma^2 + v_seed / num_seeds + diag(J C J')
///
/// What is not known is NaN and left out of sigma_total: v_seed with a single completed packing, the
/// part of the parameters without a covariance or without the runs around the set.
/// J by paired secants on the first seed, C the covariance of the fit: the interval of a prediction
/// holds what the parameters are uncertain by, as for the hold-outs of the fit itself.
/// @throws what the simulator throws
Validation validate(const ValidationProblem& problem, const Simulator& simulator);

}  // namespace tilth
