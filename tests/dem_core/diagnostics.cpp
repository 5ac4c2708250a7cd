// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Sums over an assembly.
#include "dem_core/diagnostics.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

TEST_CASE("diagnostics: energies of two pressed, sliding, turning grains",
          "[dem_core][diagnostics]") {
  Scene scene;
  scene.sphere({0, 0, 5}, 1, 2);
  scene.sphere({1.98, 0, 5}, 1, 3);
  scene.model.gravity_m_per_s2 = {0, 0, -10};
  scene.law().friction = 100;
  scene.law().dt_s = 1e-9;  // nothing moves: sums of the initial numbers
  scene.begin();
  scene.run(1);
  scene.state.set_velocity_m_per_s(0, {0, 2, 0});
  scene.state.set_angular_velocity_rad_per_s(1, {0, 0, 5});
  scene.state.contacts.spring_m[1] = 3e-3;
  const Energy e = scene.energy_now();
  CHECK_THAT(e.kinetic_J, WithinRel(0.5 * 2 * 4 + 0.5 * 0.4 * 3 * 25, 1e-12));
  CHECK_THAT(e.contacts_J, WithinRel(0.5 * 1e4 * 4e-4 + 0.5 * 5e3 * 9e-6, 1e-9));
  CHECK_THAT(e.gravity_J, WithinRel(5 * 10 * 5.0, 1e-12));
  CHECK(e.bonds_J == 0.0);
  CHECK(e.walls_J == 0.0);
}

TEST_CASE("diagnostics: energy of a strained bond and of a wall contact",
          "[dem_core][diagnostics]") {
  Scene scene;
  scene.model.contact_beside_bond = false;
  scene.sphere({0, 0, 0.9});
  scene.sphere({1.98, 0, 4});
  scene.bond(0, 1).rest_length_m += 0.01;
  scene.plane(Vec3::UnitZ());
  scene.law().bond = {.normal_scale = 100,
                      .shear_scale = 50,
                      .bending_scale = 20,
                      .twisting_scale = 10,
                      .tensile_limit = 1e9,
                      .cohesion_limit = 1e9};
  scene.law().dt_s = 1e-9;
  scene.begin();
  scene.run(1);
  for (std::size_t k = 0; k < 7; ++k) scene.state.bonds[k] = 1.0 + static_cast<double>(k);
  const Energy e = scene.energy_now();
  // shear (1, 2, 3), bending (4, 5, 6), twist 7
  CHECK_THAT(e.bonds_J, WithinRel(0.5 * (100 * 1e-4 + 14.0 / 50 + 77.0 / 20 + 49.0 / 10), 1e-9));
  CHECK_THAT(e.walls_J, WithinRel(0.5 * 1e4 * 0.01, 1e-6));
  scene.state.bonds[7] = 0;
  CHECK(scene.energy_now().bonds_J == 0.0);
}

TEST_CASE("diagnostics: momentum and angular momentum are sums over the grains",
          "[dem_core][diagnostics]") {
  Scene scene;
  scene.sphere({1, 2, 3}, 0.5, 2);
  scene.sphere({-4, 0, 1}, 1, 3);
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {1, 0, -1});
  scene.state.set_velocity_m_per_s(1, {0, 2, 0});
  scene.state.set_angular_velocity_rad_per_s(1, {0, 0, 7});
  CHECK((momentum_kg_m_per_s(scene.model, scene.state) - Vec3(2, 6, -2)).norm() < 1e-14);
  const Vec3 expected = 2 * Vec3(1, 2, 3).cross(Vec3(1, 0, -1)) +
                        3 * Vec3(-4, 0, 1).cross(Vec3(0, 2, 0)) + Vec3(0, 0, 0.4 * 3 * 7);
  CHECK((angular_momentum_kg_m2_per_s(scene.model, scene.state) - expected).norm() < 1e-13);
}

TEST_CASE("diagnostics: coordination counts touching neighbours and unbroken bonds once",
          "[dem_core][diagnostics]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.sphere({1.9, 0, 0});   // touches 0, bonded too
  scene.sphere({4.0, 0, 0});   // 0.1 m from 1, bonded to it
  scene.sphere({6.05, 0, 0});  // 0.05 m from 2, nothing
  scene.bond(0, 1);
  scene.bond(1, 2);
  scene.law().bond = {.tensile_limit = 1e9, .cohesion_limit = 1e9};
  scene.law().dt_s = 1e-9;
  scene.begin();
  scene.run(1);
  CHECK_THAT(coordination(scene.model, scene.state), WithinRel(2 * 2 / 4.0, 1e-14));
  CHECK(num_bonds_held(scene.model, scene.state) == 2);
  scene.state.bonds[8 + 7] = 0;
  CHECK_THAT(coordination(scene.model, scene.state), WithinRel(2 * 1 / 4.0, 1e-14));
  CHECK(num_bonds_held(scene.model, scene.state) == 1);
}
