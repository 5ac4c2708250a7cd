// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Fits the baseline again with effects added, by the simulator, and predicts what was held out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/evaluator.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// An effect whose size is fitted.
struct FreeEffect {
  Eigen::Index column = 0;       ///< of the parameters
  double lower = 0.0, upper = 0.0;
  Eigen::VectorXd fingerprint;   ///< (p) per unit of size, over all targets
  /// Other columns that must take a value for the effect to act.
  std::vector<std::pair<Eigen::Index, double>> nuisance = {};
};

struct RefitProblem {
  const std::vector<Parameter>& parameters;
  const std::vector<Target>& targets;
  Eigen::VectorXd measured;      ///< (p) mean T of the specimens, all targets
  Eigen::MatrixXd covariance;    ///< (p, p) of the residual
  Eigen::MatrixXd jacobian;      ///< (p, num_free) d T / d unit
  std::vector<Eigen::Index> fitted;  ///< targets that may be fitted; the others are only predicted
  std::vector<std::uint64_t> seeds;  ///< packings of the refit
};

struct Refit {
  bool is_usable = false;        ///< false: no point could be simulated
  Eigen::VectorXd unit;          ///< (num_free)
  Eigen::VectorXd sizes;         ///< of the free effects
  Eigen::VectorXd residual;      ///< (p) measured - simulated mean, all targets
  double chi_square = 0.0;       ///< of the fitted targets
  int num_steps = 0;             ///< simulated points, the first included
};

/// Gauss-Newton with the derivatives at hand (chord method), every step simulated:
///
///   minimise r' V^-1 r over unit cube and bounds of the sizes,  r = measured - m(unit, sizes)
///
/// from `unit` and `sizes`; a step that does not lower chi-square is halved. At most `max_steps` points.
/// The derivatives are those of the evidence: finite secants, good enough for a step, not for an error bar.
Refit refit(Evaluator& evaluator, const RefitProblem& problem, const Eigen::VectorXd& unit,
            const std::vector<FreeEffect>& effects, const Eigen::VectorXd& sizes, int max_steps);

}  // namespace tilth
