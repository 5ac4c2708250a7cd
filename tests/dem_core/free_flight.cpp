// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Motion without contact, against the integrator's own discrete closed forms.
#include <catch2/catch.hpp>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

TEST_CASE("free flight: free fall is the discrete parabola", "[dem_core][integration]") {
  for (const int n : {1, 10, 1000}) {
    Scene scene;
    scene.sphere({1, 2, 3}, 0.5, 7);
    scene.model.gravity_m_per_s2 = {0.5, 0, -9.81};
    scene.law().dt_s = 1e-3;
    scene.begin();
    scene.run(n);
    const double dt_s = 1e-3;
    // semi-implicit Euler: v_n = n dt g, x_n = x_0 + g dt^2 n (n + 1) / 2; 1e-13: n roundings
    CAPTURE(n);
    CHECK_THAT(scene.state.velocity_m_per_s(0).z(), WithinRel(-9.81 * n * dt_s, 1e-13));
    CHECK_THAT(scene.state.position_m(0).z(),
               WithinRel(3 - 9.81 * dt_s * dt_s * 0.5 * n * (n + 1.0), 1e-13));
    CHECK_THAT(scene.state.position_m(0).x(),
               WithinRel(1 + 0.5 * dt_s * dt_s * 0.5 * n * (n + 1.0), 1e-13));
    CHECK_THAT(scene.state.time_s[0], WithinRel(n * dt_s, 1e-13));
    CHECK(scene.state.num_steps == n);
  }
}

TEST_CASE("free flight: velocity and spin stay as they are", "[dem_core][integration]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {1, -2, 3});
  scene.state.set_angular_velocity_rad_per_s(0, {4, 5, -6});
  scene.run(1000);
  CHECK(scene.state.velocity_m_per_s(0) == Vec3(1, -2, 3));  // nothing is added: exact
  CHECK(scene.state.angular_velocity_rad_per_s(0) == Vec3(4, 5, -6));
  CHECK_THAT(scene.state.position_m(0).y(), WithinRel(-0.2, 1e-13));
}

TEST_CASE("free flight: local damping falls with (1 - alpha) g and rises with (1 + alpha) g",
          "[dem_core][damping]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.sphere({9, 0, 0});
  scene.model.gravity_m_per_s2 = {0, 0, -10};
  scene.law().local_damping = 0.3;
  scene.law().dt_s = 1e-3;
  scene.begin();
  scene.state.set_velocity_m_per_s(1, {0, 0, 10});
  scene.run(500);
  // damping.md (1); the first step from rest is not braked: v_n = -g dt (1 + 0.7 (n - 1))
  CHECK_THAT(scene.state.velocity_m_per_s(0).z(), WithinRel(-1e-2 * (1 + 0.7 * 499), 1e-12));
  CHECK_THAT(scene.state.velocity_m_per_s(1).z(), WithinRel(10 - 1.3e-2 * 500, 1e-12));
}

TEST_CASE("free flight: a model without grains or with one takes steps",
          "[dem_core][integration]") {
  Scene none;
  none.begin();
  none.run(3);
  CHECK(none.state.num_steps == 3);
  CHECK(none.energy_now().total_J() == 0.0);
}

TEST_CASE("free flight: a grain that crosses a quarter radius per step freezes its lane",
          "[dem_core][integration]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.law().dt_s = 1e-3;
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {249, 0, 0});
  CHECK(step(scene.model, scene.state, scene.workspace).any_active);
  scene.state.set_velocity_m_per_s(0, {251, 0, 0});
  const StepInfo info = step(scene.model, scene.state, scene.workspace);
  CHECK(info.lane_failed);
  CHECK_FALSE(info.any_active);
  const Vec3 frozen_m = scene.state.position_m(0);
  scene.run(5);
  CHECK(scene.state.position_m(0) == frozen_m);
  CHECK_THAT(scene.state.time_s[0], WithinAbs(2e-3, 1e-15));
}
