// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// How soil flows over the wings of a sweep.
#pragma once

#include <span>

#include "experiments/sweep_shape.hpp"

namespace tilth {

/// Mean velocity of the aggregates above the wings, volumes as weights.
struct WingFlow {
  double forward_m_per_s = 0.0;  ///< along the travel, over ground
  double outward_m_per_s = 0.0;  ///< away from the middle plane
  double volume_m3 = 0.0;        ///< of the spheres counted; 0: nobody is there
};

/// Counts whose centre is above the cutting edges and, seen from above, on the wings:
///   |y| <= width / 2,  0 <= -x - |y| / tan(sweep / 2) <= wing_depth_m(shape)
/// @param position_m  from the nose, z from the cutting edge; as many velocities and radii
WingFlow wing_flow(const SweepShape& shape, std::span<const Vec3> position_m,
                   std::span<const Vec3> velocity_m_per_s, std::span<const double> radius_m);

/// Angle of the flow over the tool to the vertical plane along the travel, positive outwards:
///   atan2(outward, tool speed - forward)
/// Relative to the tool, as scratches on a wing show it.
double flow_angle_rad(double forward_m_per_s, double outward_m_per_s, double tool_speed_m_per_s);

}  // namespace tilth
