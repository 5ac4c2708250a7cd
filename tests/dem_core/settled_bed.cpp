// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The settled frictional bed (tests/reference/settled_bed).
#include <catch2/catch.hpp>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

TEST_CASE("settled bed keeps the coordination number of the reference", "[dem_core][reference]") {
  Scene scene;
  for (const auto& row :
       testing::read_table(TILTH_SOURCE_DIR "/tests/reference/settled_bed/settled_4k.csv"))
    scene.sphere({row[0], row[1], row[2]}, row[3]);
  REQUIRE(scene.model.num_particles() == 4000);
  scene.model.mass_kg = sphere_masses_kg(scene.model.radius_m, 1.0);
  scene.model.damping_kind = DampingKind::rate;
  scene.model.gravity_m_per_s2 = {0, 0, -1};
  scene.model.skin_m = 0.3;
  LaneLaw& law = scene.law();
  law.contact_stiffness = 2e4;
  law.shear_stiffness_ratio = 0.5;
  law.friction = 0.5;
  law.normal_damping = 40;
  law.tangential_damping = 20;
  law.dt_s = 5e-4;
  const Vec3 size_m(32.293201, 32.293201, 64.586402);
  for (int axis = 0; axis < 3; ++axis) {
    scene.plane(Vec3::Unit(axis));
    scene.plane(-Vec3::Unit(axis), size_m);
  }
  scene.begin();
  scene.run(2000);
  // 0.05: the table has two decimals and a bed that was handed over settles by a few contacts of 10
  // 740
  CHECK_THAT(coordination(scene.model, scene.state), WithinAbs(5.37, 0.05));
  // at rest: the floor (wall 4) carries the weight; 1e-3: what still moves
  double weight_N = 0;
  for (const double m : scene.model.mass_kg) weight_N += m;
  CHECK_THAT(-scene.state.wall_force_N(4).z(), WithinRel(weight_N, 1e-3));
}
