// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/servo.hpp"

#include <cmath>

namespace tilth {

void hold_stress(LaneRun& run, int wall, int lane, double stress_Pa, double area_m2,
                 double max_speed_m_per_s) {
  const LaneLaw& law = run.specimen.model.lanes[static_cast<std::size_t>(lane)];
  const double layer_N_per_m =
      0.6 * law.contact_stiffness * area_m2 / run.specimen.mean_radius_m;
  WallDrive& drive = run.specimen.state.drive(wall, lane);
  drive.velocity_m_per_s = Vec3::Zero();
  drive.servo_gain_m_per_N_s = 0.3 / (layer_N_per_m * law.dt_s);
  drive.servo_integral_gain_m_per_N_s2 = 1e-3 / (layer_N_per_m * law.dt_s * law.dt_s);
  drive.target_force_N = stress_Pa * area_m2;
  drive.max_speed_m_per_s = max_speed_m_per_s;
}

bool SteadyStress::update(double stress_Pa, double target_Pa) {
  intervals = std::abs(stress_Pa - target_Pa) < 0.02 * target_Pa ? intervals + 1 : 0;
  return intervals >= 3;
}

}  // namespace tilth
