// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Derivatives of a smooth, noise-free simulator: differences extrapolated to step zero.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calibrate/secants.hpp"

namespace tilth {

/// Limit of difference quotients at steps h, h/2, h/4, ..., by Neville's scheme, per component the
/// entry of the triangle that agrees best with its neighbours.
///
///   D_i,k = (ratio^k D_i,k-1 - D_i-1,k-1) / (ratio^k - 1)
///
/// @param quotients  largest step first, at least one
/// @param ratio      4 for central differences (errors h^2, h^4, ...), 2 for one-sided ones
/// @source Ridders, Advances in Engineering Software 4 (1982) 75
Eigen::VectorXd extrapolated_quotient(const std::vector<Eigen::VectorXd>& quotients, double ratio);

/// As paired_secants(), for simulators without noise: the step is 5 % of the coordinate (of v on a
/// log scale; a parameter's secant_step where it states one; at least 1e-6 of the range) and is
/// halved seven times. Central, or one-sided where a bound is nearer than the step. Relative error
/// about 1e-10 where the model is smooth over 5 %. Steps whose runs fail are left out together with
/// all larger ones; a parameter without any is frozen.
/// @cost at most (1 + 16 num_free) simulations per seed
std::optional<Secants> extrapolated_derivatives(Evaluator& evaluator,
                                                std::span<const Parameter> parameters,
                                                std::span<const Target> targets,
                                                const Eigen::VectorXd& unit,
                                                std::span<const std::uint64_t> seeds);

}  // namespace tilth
