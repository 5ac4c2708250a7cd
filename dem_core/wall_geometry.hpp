// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Distance from a point to a wall, one lane; the same formulas as the kernel's.
#pragma once

#include "dem_core/state.hpp"

namespace tilth {

/// Signed distance to the wall as placed in `lane`: planes positive on the normal's side, bounded
/// planes the distance to the nearest point of the rectangle (infinite beside one without edges),
/// cylinders R minus the axial distance.
double wall_distance_m(const Model& model, const State& state, int wall, const Vec3& point_m,
                       int lane = 0);

/// The same, but beside a rectangle without edges the distance to its nearest point: how far the grain
/// has to go to meet the wall.
double distance_to_reach_wall_m(const Model& model, const State& state, int wall,
                                const Vec3& point_m, int lane = 0);

/// Unit vector along which the wall pushes a grain at the point: towards the axis of a cylinder, away
/// from the nearest point of a rectangle.
Vec3 wall_normal(const Model& model, const State& state, int wall, const Vec3& point_m,
                 int lane = 0);

}  // namespace tilth
