// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Bounded minimisation without derivatives, with no solver type in sight.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>

namespace tilth {

enum class NloptAlgorithm {
  direct_l,  ///< deterministic global search by dividing rectangles
  crs2,      ///< controlled random search, global
  isres,     ///< evolution strategy, global
  sbplx,     ///< Nelder-Mead on subspaces, local
  bobyqa,    ///< quadratic models, local; two dimensions or more
};

struct NloptOptions {
  NloptAlgorithm algorithm = NloptAlgorithm::sbplx;
  int max_evaluations = 1000;
  double xtol = 1e-6;      ///< stop when every |dx_i| <= xtol * (upper_i - lower_i); 0 = never
  std::uint64_t seed = 1;  ///< of the random algorithms
};

struct NloptResult {
  Eigen::VectorXd x;   ///< the best point evaluated, whatever happened afterwards
  double value = 0.0;  ///< its objective; NaN if no finite one was seen
  int num_evaluations = 0;
  bool converged = false;  ///< xtol was met
  std::string message;
};

/// Minimises objective(x) over lower <= x <= upper.
///
/// The objective at `start` must be finite. Later non-finite values are shown to the algorithm as
/// the worst finite value seen so far, and never returned. NLopt's random generator belongs to a
/// thread; it is seeded here, on the thread that runs, so equal calls give equal bits.
/// @shape lower, upper, start (n), n >= 1, lower < upper
/// @throws what the objective throws; never for a failure inside NLopt
/// @source NLopt 2.7 manual; DIRECT-L Gablonsky & Kelley 2001, CRS2 Kaelo & Ali 2006, ISRES
///         Runarsson & Yao 2005, Sbplx after Rowan 1990, BOBYQA Powell 2009
NloptResult minimise_with_nlopt(const std::function<double(const Eigen::VectorXd&)>& objective,
                                const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                const Eigen::VectorXd& start, const NloptOptions& options);

}  // namespace tilth
