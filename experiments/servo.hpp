// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A platen that holds a stress.
#pragma once

#include "experiments/lane_run.hpp"

namespace tilth {

/// Lets a plane wall of one lane move along its normal to hold `stress_Pa` on `area_m2`.
///
///   speed = gain (target - force),   gain = 0.05 / (k_layer dt),   k_layer = 0.6 E_c A / r
///
/// k_layer is the stiffness of a layer of grains touching the wall (area fraction 0.6, E_c pi r
/// each), so that a twentieth of the force error is closed per step. The speed is limited.
/// @source own choice, in the manner of Potyondy & Cundall 2004, section 2.5
void hold_stress(LaneRun& run, int wall, int lane, double stress_Pa, double area_m2,
                 double max_speed_m_per_s);

}  // namespace tilth
