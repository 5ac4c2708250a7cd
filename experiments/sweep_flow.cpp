// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/sweep_flow.hpp"

#include <cmath>
#include <numbers>

namespace tilth {

WingFlow wing_flow(const SweepShape& shape, std::span<const Vec3> position_m,
                   std::span<const Vec3> velocity_m_per_s, std::span<const double> radius_m) {
  const double depth_m = wing_depth_m(shape);
  const double slope = 1 / std::tan(0.5 * shape.sweep_angle_rad);
  WingFlow flow;
  for (std::size_t i = 0; i < position_m.size(); ++i) {
    const Vec3& x = position_m[i];
    const double behind_edge_m = -x.x() - std::abs(x.y()) * slope;
    if (x.z() < 0 || std::abs(x.y()) > 0.5 * shape.width_m || behind_edge_m < 0 || behind_edge_m > depth_m)
      continue;
    const double volume_m3 = radius_m[i] * radius_m[i] * radius_m[i];  // the factor comes at the end
    flow.forward_m_per_s += volume_m3 * velocity_m_per_s[i].x();
    flow.outward_m_per_s += volume_m3 * (x.y() < 0 ? -1 : 1) * velocity_m_per_s[i].y();
    flow.volume_m3 += volume_m3;
  }
  if (flow.volume_m3 == 0.0) return flow;
  flow.forward_m_per_s /= flow.volume_m3;
  flow.outward_m_per_s /= flow.volume_m3;
  flow.volume_m3 *= 4.0 / 3 * std::numbers::pi;
  return flow;
}

double flow_angle_rad(double forward_m_per_s, double outward_m_per_s, double tool_speed_m_per_s) {
  return std::atan2(outward_m_per_s, tool_speed_m_per_s - forward_m_per_s);
}

}  // namespace tilth
