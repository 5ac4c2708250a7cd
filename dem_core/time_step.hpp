// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The automatic time step: a rigorous bound, snapped down to a ladder.
#pragma once

#include "dem_core/state.hpp"

namespace tilth {

/// Largest step for which semi-implicit Euler is stable on the linearised assembly:
///   dt = 2 / omega,   omega^2 = max_i lambda_max( M_i^-1/2 (2 sum_j K_ij + sum_w K_iw) M_i^-1/2 )
/// with the 6x6 stiffness K_ij of every contact and bond as seen from grain i alone. It bounds the
/// true highest frequency from above because x'Kx = sum |B_i x_i - B_j x_j|^2_D
/// <= 2 sum (|B_i x_i|^2_D + |B_j x_j|^2_D). A normal dashpot of ratio zeta shortens it by
/// sqrt(1 + zeta^2) - zeta. Pairs within 2 % of their reference distance count as touching.
/// @return dt [s]; infinity when nothing touches
/// @source own derivation, docs/theory/time_step.md
double stable_time_step_s(const Model& model, const State& state, int lane = 0);

/// The ladder 2^(k/4) s, rounded down: members of like stiffness share a step.
double ladder_time_step_s(double dt_s);

}  // namespace tilth
