// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/wall_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tilth {

namespace {

double beyond(double x, double half) { return x - std::clamp(x, -half, half); }

}  // namespace

double distance_to_reach_wall_m(const Model& model, const State& state, int wall,
                                const Vec3& point_m, int lane) {
  const Wall& w = model.walls[static_cast<std::size_t>(wall)];
  const Vec3 offset = point_m - state.wall_position_m(wall, lane);
  const double along = offset.dot(w.direction);
  if (w.shape == WallShape::cylinder) {
    const std::size_t lanes = static_cast<std::size_t>(state.num_lanes);
    const double radius_m =
        state.walls[(static_cast<std::size_t>(wall) * 4 + 3) * lanes +
                    static_cast<std::size_t>(lane)];
    return radius_m - (offset - along * w.direction).norm();
  }
  if (!w.bounded()) return along;
  const double da = beyond(offset.dot(w.tangent_a), w.half_a_m);
  const double db = beyond(offset.dot(w.tangent_b), w.half_b_m);
  if (da == 0 && db == 0) return along;
  return std::sqrt(along * along + da * da + db * db);
}

double wall_distance_m(const Model& model, const State& state, int wall, const Vec3& point_m,
                       int lane) {
  const Wall& w = model.walls[static_cast<std::size_t>(wall)];
  if (!w.has_edges && w.bounded()) {
    const Vec3 offset = point_m - state.wall_position_m(wall, lane);
    if (beyond(offset.dot(w.tangent_a), w.half_a_m) != 0 ||
        beyond(offset.dot(w.tangent_b), w.half_b_m) != 0)
      return std::numeric_limits<double>::infinity();
  }
  return distance_to_reach_wall_m(model, state, wall, point_m, lane);
}

Vec3 wall_normal(const Model& model, const State& state, int wall, const Vec3& point_m, int lane) {
  const Wall& w = model.walls[static_cast<std::size_t>(wall)];
  const Vec3 offset = point_m - state.wall_position_m(wall, lane);
  const double along = offset.dot(w.direction);
  if (w.shape == WallShape::cylinder) return (along * w.direction - offset).normalized();
  if (!w.bounded()) return w.direction;
  const double da = beyond(offset.dot(w.tangent_a), w.half_a_m);
  const double db = beyond(offset.dot(w.tangent_b), w.half_b_m);
  if (da == 0 && db == 0) return w.direction;
  return (along * w.direction + da * w.tangent_a + db * w.tangent_b).normalized();
}

}  // namespace tilth
