// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/triaxial_box.hpp"

#include <numbers>

#include "experiments/servo.hpp"

namespace tilth {
namespace {

int lower_wall(int axis) { return 2 * axis; }
int upper_wall(int axis) { return 2 * axis + 1; }

}  // namespace

std::vector<Wall> box_plates(const Vec3& size_m) {
  std::vector<Wall> walls;
  for (int axis = 0; axis < 3; ++axis) {
    walls.push_back({.direction = Vec3::Unit(axis)});
    walls.push_back({.direction = -Vec3::Unit(axis), .position_m = size_m[axis] * Vec3::Unit(axis)});
  }
  return walls;
}

Vec3 box_size_m(const LaneRun& run, int lane) {
  Vec3 size_m;
  for (int axis = 0; axis < 3; ++axis)
    size_m[axis] = run.specimen.state.wall_position_m(upper_wall(axis), lane)[axis] -
                   run.specimen.state.wall_position_m(lower_wall(axis), lane)[axis];
  return size_m;
}

double plate_area_m2(const Vec3& size_m, int axis) { return size_m.prod() / size_m[axis]; }

double box_stress_Pa(const LaneRun& run, int lane, int axis) {
  return 0.5 *
         (run.wall_force_N(upper_wall(axis), lane)[axis] -
          run.wall_force_N(lower_wall(axis), lane)[axis]) /
         plate_area_m2(box_size_m(run, lane), axis);
}

void hold_box_stress(LaneRun& run, int lane, int axis, double stress_Pa, double max_speed_m_per_s) {
  hold_stress(run, upper_wall(axis), lane, stress_Pa, plate_area_m2(box_size_m(run, lane), axis),
              max_speed_m_per_s);
}

void update_box_stress(LaneRun& run, int lane, int axis, double stress_Pa) {
  run.specimen.state.drive(upper_wall(axis), lane).target_force_N =
      stress_Pa * plate_area_m2(box_size_m(run, lane), axis);
}

double void_ratio(const LaneRun& run, int lane) {
  double solid_m3 = 0.0;
  for (const double r : run.specimen.model.radius_m)
    solid_m3 += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return box_size_m(run, lane).prod() / solid_m3 - 1.0;
}

}  // namespace tilth
