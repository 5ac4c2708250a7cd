// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Packings of one point, and means over them: what a point of the unit cube gives in the transformed quantities.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calibrate/evaluator.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// T(feature) of every target of a completed run. A hold-out on a log scale that is not positive
/// gives NaN; all other entries are finite.
Eigen::VectorXd transformed_features(std::span<const Target> targets, const Evaluation& run);

/// T(feature) of one point on every packing that completed, failed ones left out.
/// @shape unit (num_free), result (num_targets, num_completed)
Eigen::MatrixXd samples_over_seeds(Evaluator& evaluator, std::span<const Parameter> parameters,
                                   std::span<const Target> targets, const Eigen::VectorXd& unit,
                                   std::span<const std::uint64_t> seeds);

/// Mean over the seeds of T(feature), one entry per column; empty where any seed failed or was
/// skipped, since a missing packing would shift the mean against the other points.
/// @shape unit_points (num_free, num_points)
std::vector<std::optional<Eigen::VectorXd>> average_over_seeds(
    Evaluator& evaluator, std::span<const Parameter> parameters, std::span<const Target> targets,
    const Eigen::MatrixXd& unit_points, std::span<const std::uint64_t> seeds);

}  // namespace tilth
