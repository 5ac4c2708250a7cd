// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Energy, momentum and angular momentum of assemblies without outside forces.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using tilth::testing::add_bonded_cluster;
using tilth::testing::Scene;

namespace {

constexpr double closing_speed_m_per_s = 2.0;

/// Two bonded clusters of 8 grains that fly into each other off-centre, spinning.
Scene clusters(double strength) {
  Scene scene;
  scene.law().bond = {.normal_scale = 1e4,
                      .shear_scale = 5e3,
                      .bending_scale = 2e3,
                      .twisting_scale = 1e3,
                      .tensile_limit = strength,
                      .cohesion_limit = strength,
                      .tan_friction = 0.3,
                      .bending_in_tension = 0.5,
                      .twisting_in_shear = 0.5};
  scene.model.contact_beside_bond = false;
  add_bonded_cluster(scene, {-4, 0, 0}, 8, 2.6, 1);
  add_bonded_cluster(scene, {4, 0.7, 0.3}, 8, 2.6, 2);
  // bonded grains may overlap: their contacts count from the distance they have at the start
  for (int i = 0; i < 16; ++i)
    for (int j = i + 1; j < 16; ++j) {
      const double distance_m =
          (scene.start_m[static_cast<std::size_t>(j)] - scene.start_m[static_cast<std::size_t>(i)])
              .norm();
      if (distance_m < scene.model.radius_m[static_cast<std::size_t>(i)] +
                           scene.model.radius_m[static_cast<std::size_t>(j)])
        scene.model.references.push_back({i, j, distance_m});
    }
  return scene;
}

void launch(Scene& scene) {
  scene.begin();
  for (int i = 0; i < 16; ++i) {
    const double side = i < 8 ? 1 : -1;
    const Vec3 spin(0.1, 0.2 * side, 0.3);
    const Vec3 arm = scene.state.position_m(i) - Vec3(-4 * side, 0, 0);
    scene.state.set_velocity_m_per_s(
        i, Vec3(0.5 * side * closing_speed_m_per_s, 0, 0) + spin.cross(arm));
    scene.state.set_angular_velocity_rad_per_s(i, spin);
  }
}

/// Largest change of the total energy over the kinetic energy at the start, in 4 s of a collision.
double energy_error(double dt_s) {
  Scene scene = clusters(1e30);
  scene.law().dt_s = dt_s;
  launch(scene);
  scene.run(1);
  const double start_J = scene.energy_now().total_J();
  double worst_J = 0;
  while (scene.state.active[0] && scene.state.time_s[0] < 4) {
    scene.run(1);
    worst_J = std::max(worst_J, std::abs(scene.energy_now().total_J() - start_J));
  }
  return worst_J / start_J;
}

}  // namespace

TEST_CASE("conservation: the energy error of an elastic assembly falls with the step",
          "[dem_core][conservation]") {
  const double coarse = energy_error(1e-3);
  const double fine = energy_error(2.5e-4);
  CAPTURE(coarse, fine);
  // semi-implicit Euler keeps a nearby energy that differs by O(dt): order 1
  CHECK_THAT(std::log2(coarse / fine) / 2, WithinAbs(1.0, 0.2));
  CHECK(fine < 5e-3);
}

TEST_CASE("conservation: the energy of an elastic assembly does not drift",
          "[dem_core][conservation]") {
  Scene scene = clusters(1e30);
  scene.law().dt_s = 5e-4;
  launch(scene);
  scene.run(1);
  const double start_J = scene.energy_now().total_J();
  scene.run(40000);
  double mean_J = 0;
  for (int n = 0; n < 2000; ++n) {
    scene.run(1);
    mean_J += scene.energy_now().total_J() / 2000;
  }
  // 2e-3: after 20 s, some 300 periods, no more than the error within one collision
  CHECK_THAT(mean_J / start_J, WithinAbs(1, 2e-3));
}

TEST_CASE("conservation: momentum and angular momentum survive impact, friction and fracture",
          "[dem_core][conservation]") {
  Scene scene = clusters(60);
  scene.law().friction = 0.4;
  scene.law().normal_damping = damping_number(0.5);
  scene.law().tangential_damping = 0.2;
  launch(scene);
  const Vec3 p0 = momentum_kg_m_per_s(scene.model, scene.state);
  const Vec3 l0 = angular_momentum_kg_m2_per_s(scene.model, scene.state);
  scene.run(30000);
  REQUIRE(num_bonds_held(scene.model, scene.state) < static_cast<int>(scene.model.bonds.size()));
  // every force acts twice with opposite sign at one point: only rounding, 1e-12 of 16 grains'
  // momenta of 1 kg m/s and of 4 kg m2/s after 30 000 steps
  CHECK((momentum_kg_m_per_s(scene.model, scene.state) - p0).norm() < 1e-12 * 16);
  CHECK((angular_momentum_kg_m2_per_s(scene.model, scene.state) - l0).norm() < 1e-12 * 64);
}

TEST_CASE("conservation: an oblique impact of two unequal grains keeps both momenta",
          "[dem_core][conservation]") {
  Scene scene;
  scene.sphere({0, 0, 0}, 1, 1);
  scene.sphere({3, 0.8, 0.4}, 1.5, 4);
  scene.law().friction = 0.5;
  scene.law().normal_damping = 0.3;
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {3, 0, 0});
  scene.state.set_angular_velocity_rad_per_s(0, {1, -2, 5});
  const Vec3 l0 = angular_momentum_kg_m2_per_s(scene.model, scene.state);
  scene.run(5000);
  REQUIRE(scene.state.velocity_m_per_s(1).norm() > 0.1);
  CHECK((momentum_kg_m_per_s(scene.model, scene.state) - Vec3(3, 0, 0)).norm() < 1e-13);
  CHECK((angular_momentum_kg_m2_per_s(scene.model, scene.state) - l0).norm() < 1e-12);
}

TEST_CASE("conservation: friction and damping only take energy", "[dem_core][conservation]") {
  Scene scene = clusters(60);
  scene.law().friction = 0.4;
  scene.law().normal_damping = damping_number(0.5);
  scene.law().dt_s = 2.5e-4;
  launch(scene);
  scene.run(1);
  const double start_J = scene.energy_now().total_J();
  scene.run(12000);
  const double end_J = scene.energy_now().total_J();
  CAPTURE(start_J, end_J);
  CHECK(end_J < 0.95 * start_J);
  CHECK(end_J > 0);
}
