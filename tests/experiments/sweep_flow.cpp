// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Flow over the wings: who is counted, signs, weights, and the angle relative to the tool.
#include "experiments/sweep_flow.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("sweep flow: aggregates above the wings only, outward on both sides, by volume", "[experiments][sweep]") {
  const SweepShape shape;  // 0.25 m wide, 70 degrees, wings 0.112 m deep
  const double edge_m = 0.1 / std::tan(0.5 * shape.sweep_angle_rad);  // behind the nose, 0.1 m aside
  const std::vector<Vec3> position_m = {
      {-edge_m - 0.01, 0.1, 0.02},    // on the left wing
      {-edge_m - 0.05, -0.1, 0.05},   // on the right wing, twice the radius
      {-edge_m + 0.01, 0.1, 0.02},    // before the edge
      {-edge_m - 0.12, 0.1, 0.02},    // behind the wing
      {-edge_m - 0.01, 0.1, -0.001},  // below the edge
      {-0.20, 0.13, 0.02}};           // beside the tool
  const std::vector<Vec3> velocity_m_per_s = {{0.5, 0.1, 0}, {0.2, -0.04, 0}, {9, 9, 9},
                                              {9, 9, 9},     {9, 9, 9},       {9, 9, 9}};
  const std::vector<double> radius_m = {0.01, 0.02, 0.01, 0.01, 0.01, 0.01};
  const WingFlow flow = wing_flow(shape, position_m, velocity_m_per_s, radius_m);
  CHECK_THAT(flow.forward_m_per_s, WithinRel((0.5 + 8 * 0.2) / 9, 1e-12));
  CHECK_THAT(flow.outward_m_per_s, WithinRel((0.1 + 8 * 0.04) / 9, 1e-12));
  CHECK_THAT(flow.volume_m3, WithinRel(4.0 / 3 * 3.14159265358979 * 9e-6, 1e-12));
  CHECK(wing_flow(shape, {}, {}, {}).volume_m3 == 0);
}

TEST_CASE("sweep flow: the angle is that of a scratch on the wing", "[experiments][sweep]") {
  CHECK(flow_angle_rad(0.0, 0.0, 0.9) == 0);
  CHECK_THAT(flow_angle_rad(0.4, 0.1, 0.9), WithinRel(std::atan(0.2), 1e-12));
  CHECK(flow_angle_rad(0.4, -0.1, 0.9) < 0);
  // soil that only steps aside, the tool passing under it
  CHECK_THAT(flow_angle_rad(0.0, 0.9, 0.9), WithinAbs(std::atan(1.0), 1e-12));
}
