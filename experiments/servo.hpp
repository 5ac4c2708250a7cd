// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A platen that holds a stress.
#pragma once

#include "experiments/lane_run.hpp"

namespace tilth {

/// Lets a plane wall of one lane move along its normal to hold `stress_Pa` on `area_m2`.
///
///   speed = G e + integral,   d(integral)/dt = G_i e,   e = target - force,
///   G = 0.3 / (k dt),   G_i = 1e-3 / (k dt^2),   k = 0.6 E_c A / r
///
/// k is the stiffness of the layer of grains at the wall (area fraction 0.6, E_c pi r each). The
/// specimen behind it, some 0.15 k stiff, then answers a step with time constant dt / 0.045, well
/// damped (zeta = 0.3 sqrt(0.15) / (2 sqrt(1e-3)) = 1.8); the integral follows a steady dilation.
/// The speed is limited.
/// @source own choice
void hold_stress(LaneRun& run, int wall, int lane, double stress_Pa, double area_m2,
                 double max_speed_m_per_s);

/// Counts consecutive intervals in which a stress is within 2 % of its target.
struct SteadyStress {
  int intervals = 0;
  /// True from the third such interval on.
  bool update(double stress_Pa, double target_Pa);
};

}  // namespace tilth
