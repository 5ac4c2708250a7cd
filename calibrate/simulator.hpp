// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What a fit needs from a model: features for a batch of parameter sets.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tilth {

/// How one simulation ended.
enum class EvaluationStatus {
  completed,  ///< all features are finite; of a partial simulator, one at least
  failed,     ///< no valid result: diverged, timed out, not finite; recorded, never retried
  skipped,    ///< not run, because a stop was asked or the budget is spent
};

/// The result of one simulation. A failed one carries a reason instead of a number.
struct Evaluation {
  EvaluationStatus status = EvaluationStatus::skipped;
  Eigen::VectorXd features;  ///< physical, one per target, in target order; empty unless completed
  std::string message;       ///< why it, or a test of a partial simulator, failed; else empty
};

/// Runs one batch.
///
/// @shape parameters (num_parameters, num_members): physical, one column per member, all
///        parameters including the fixed ones, in table order
/// @shape seeds (num_members): the packing (random state) of each member
/// @return one Evaluation per column. Must be a pure function of (column, seed): the companions
///         and the number of threads may not change a bit. It may throw only if the machine fails.
///         A *partial* simulator gives NaN for features of tests that failed, and the reasons as the
///         message, instead of a failed member; only some users ask for that.
using Simulator = std::function<std::vector<Evaluation>(const Eigen::MatrixXd& parameters,
                                                        std::span<const std::uint64_t> seeds)>;

}  // namespace tilth
