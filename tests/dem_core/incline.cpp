// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Friction on an incline: the plane is z = 0, gravity is tilted. Closed forms of rigid bodies.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

namespace {

/// Gravity of 1 m/s2 tilted by the angle, contacts damped so that transients die out.
Scene incline(double angle_rad, double friction) {
  Scene scene;
  scene.plane(Vec3::UnitZ());
  scene.model.gravity_m_per_s2 = {std::sin(angle_rad), 0, -std::cos(angle_rad)};
  scene.law().wall_friction = friction;
  scene.law().normal_damping = 1.0;
  scene.law().tangential_damping = 0.5;
  scene.law().dt_s = 1e-3;
  return scene;
}

/// Height at which a sphere of 1 m and 1 kg is carried by the plane.
double resting_height_m(double angle_rad) { return 1 - std::cos(angle_rad) / 1e4; }

/// I / (m d^2) of a sphere rolling with its centre d above the plane.
double inertia_ratio(double height_m) { return 0.4 / (height_m * height_m); }

/// Three bonded spheres that cannot roll; returns the speed gained per second in the last half and
/// how far they travel in it.
double block_acceleration(double angle_rad, double friction, double& travelled_m) {
  Scene scene = incline(angle_rad, friction);
  const double z = resting_height_m(angle_rad);
  scene.sphere({0, 0, z});
  scene.sphere({2.5, 1.4, z});
  scene.sphere({2.5, -1.4, z});
  scene.bond(0, 1);
  scene.bond(0, 2);
  scene.bond(1, 2);
  scene.law().bond = {.normal_scale = 1e5,
                      .shear_scale = 1e5,
                      .bending_scale = 1e5,
                      .twisting_scale = 1e5,
                      .tensile_limit = 1e9,
                      .cohesion_limit = 1e9};
  scene.begin();
  scene.run(5000);
  const double early = scene.state.velocity_m_per_s(0).x();
  const double early_m = scene.state.position_m(0).x();
  scene.run(5000);
  travelled_m = scene.state.position_m(0).x() - early_m;
  return (scene.state.velocity_m_per_s(0).x() - early) / 5;
}

}  // namespace

TEST_CASE("incline: a block slides where tan(angle) exceeds the friction and sticks below",
          "[dem_core][friction]") {
  const double friction = 0.4;
  for (const double ratio : {0.90, 0.98, 1.02, 1.10, 2.0}) {
    const double angle_rad = std::atan(ratio * friction);
    double travelled_m = 0;
    const double a = block_acceleration(angle_rad, friction, travelled_m);
    const double closed_form = std::max(0.0, std::sin(angle_rad) - friction * std::cos(angle_rad));
    CAPTURE(ratio, travelled_m);
    // 1e-6 g: what the damped rocking of the block leaves after 5 s
    CHECK_THAT(a, WithinAbs(closed_form, 1e-6));
    // sticking: no creep once the load's sudden start (1e-3 m of slip) is over
    if (ratio < 1) CHECK(std::abs(travelled_m) < 1e-9);
  }
}

TEST_CASE("incline: a sphere without slip accelerates with 5/7 g sin(angle)",
          "[dem_core][friction]") {
  for (const double angle_rad : {0.1, 0.5, 0.9}) {
    Scene scene = incline(angle_rad, 1.0);
    const double z = resting_height_m(angle_rad);
    scene.sphere({0, 0, z});
    scene.begin();
    scene.run(10000);
    // 5/7 for d = r; the overlap makes it 1 / (1 + 0.4 r^2 / d^2). 1e-9: the damped transient is
    // gone
    const double a = std::sin(angle_rad) / (1 + inertia_ratio(z));
    CAPTURE(angle_rad);
    CHECK_THAT(scene.state.velocity_m_per_s(0).x(), WithinRel(10 * a, 1e-9));
    CHECK_THAT(a, WithinRel(5.0 / 7 * std::sin(angle_rad), 1e-4));
    CHECK_THAT(scene.state.angular_velocity_rad_per_s(0).y() * z,
               WithinRel(scene.state.velocity_m_per_s(0).x(), 1e-6));  // the dashpot's creep
  }
}

TEST_CASE("incline: a slipping sphere follows the closed form of Coulomb friction",
          "[dem_core][friction]") {
  const double angle_rad = 0.8;
  const double friction = 0.2;  // no slip would need 2/7 tan(0.8) = 0.294
  Scene scene = incline(angle_rad, friction);
  const double z = resting_height_m(angle_rad);
  scene.sphere({0, 0, z});
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {5, 0, 0});
  scene.run(10000);
  const double cosine = std::cos(angle_rad);
  // 1e-4: in the first step the spring has not yet reached the slip limit (1 of 10 000)
  CHECK_THAT(scene.state.velocity_m_per_s(0).x(),
             WithinRel(5 + 10 * (std::sin(angle_rad) - friction * cosine), 1e-4));
  CHECK_THAT(scene.state.angular_velocity_rad_per_s(0).y(),
             WithinRel(10 * 2.5 * friction * cosine * z, 1e-4));
}

TEST_CASE("incline: a sphere thrown along a level plane ends rolling at 5/7 of its speed",
          "[dem_core][friction]") {
  Scene scene = incline(0, 0.3);
  const double z = resting_height_m(0);
  scene.sphere({0, 0, z});
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {1, 0, 0});
  scene.run(500);
  // slipping until 2/7 v / (mu g) = 0.95 s; 1e-3 of the loss: at most one step without slip of 500
  CHECK_THAT(1 - scene.state.velocity_m_per_s(0).x(), WithinRel(0.3 * 0.5, 2e-3));
  scene.run(4500);
  // angular momentum about the contact point is kept: v = v0 / (1 + 0.4 r^2 / d^2)
  const double v = 1 / (1 + inertia_ratio(z));
  CHECK_THAT(scene.state.velocity_m_per_s(0).x(), WithinRel(v, 1e-9));
  CHECK_THAT(v, WithinRel(5.0 / 7, 1e-4));
}
