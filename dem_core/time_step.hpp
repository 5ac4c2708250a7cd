// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The automatic time step: a rigorous bound, snapped down to a ladder.
#pragma once

#include "dem_core/state.hpp"

namespace tilth {

/// Largest step for which semi-implicit Euler is stable on the linearised assembly:
///   dt = min_i 4 / (c_i + sqrt(c_i^2 + 4 k_i)),    2 / sqrt(max k_i) without dashpots,
///   k_i = lambda_max( M_i^-1/2 (2 sum_j K_ij + sum_w K_iw) M_i^-1/2 ),   c_i the same of dashpots
/// with the 6x6 stiffness K_ij of every contact and bond as seen from grain i alone. It is never
/// above the limit of the assembled system because x'Kx = sum |B_i x_i - B_j x_j|^2_D
/// <= 2 sum (|B_i x_i|^2_D + |B_j x_j|^2_D), and the same of the dashpots. Pairs closer than 1.02
/// times their radii count as touching.
/// @return dt [s]; infinity when nothing touches
/// @source own derivation, docs/theory/time_step.md
double stable_time_step_s(const Model& model, const State& state, int lane = 0);

/// The ladder 2^(k/4) s, rounded down: members of like stiffness share a step.
double ladder_time_step_s(double dt_s);

}  // namespace tilth
