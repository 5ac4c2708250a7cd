// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Walls: planes, rectangles with edges, cylinders, servos, torque and friction.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "dem_core/packing.hpp"
#include "dem_core/time_step.hpp"
#include "dem_core/wall_geometry.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

namespace {

/// Force on the only grain, from the momentum it gains in one step.
Vec3 force_on_grain_N(Scene& scene) {
  scene.begin();
  scene.run(1);
  return scene.state.velocity_m_per_s(0) * scene.model.mass_kg[0] / scene.law().dt_s;
}

Scene with_rectangle(const Vec3& grain_m) {
  Scene scene;
  scene.sphere(grain_m);
  Wall plate;
  plate.half_a_m = 3;
  plate.half_b_m = 2;
  plate.position_m = {10, 20, 30};
  scene.model.walls.push_back(plate);
  return scene;
}

}  // namespace

TEST_CASE("walls: a sphere resting on a plane sinks by m g / k", "[dem_core][walls]") {
  for (const StiffnessKind kind : {StiffnessKind::per_contact, StiffnessKind::modulus}) {
    Scene scene;
    scene.sphere({0, 0, 0.5}, 0.5, 2);
    scene.plane(Vec3::UnitZ());
    scene.model.stiffness_kind = kind;
    scene.model.gravity_m_per_s2 = {0, 0, -10};
    scene.law().normal_damping = 1;
    scene.law().dt_s = 1e-3;
    scene.begin();
    scene.run(3000);
    // k = 1e4 N/m, or E pi r; 1e-9: the damped bounce is gone
    const double k = kind == StiffnessKind::modulus ? 1e4 * std::numbers::pi * 0.5 : 1e4;
    CHECK_THAT(0.5 - scene.state.position_m(0).z(), WithinRel(20 / k, 1e-9));
    CHECK_THAT(scene.state.wall_force_N(0).z(), WithinRel(-20.0, 1e-9));
  }
}

TEST_CASE("walls: the edge and the corner of a rectangle push along the shortest way",
          "[dem_core][walls]") {
  struct Case {
    Vec3 grain_m;    ///< from the rectangle's centre
    Vec3 nearest_m;  ///< point of the rectangle
  };
  const Vec3 centre_m(10, 20, 30);
  for (const Case& c : {Case{{1, -1, 0.9}, {1, -1, 0}}, Case{{3.5, 1, 0.6}, {3, 1, 0}},
                        Case{{-3.5, 1, 0.6}, {-3, 1, 0}}, Case{{0, 2.7, 0.1}, {0, 2, 0}},
                        Case{{3.4, -2.3, 0.5}, {3, -2, 0}}, Case{{3.6, 0, -0.4}, {3, 0, 0}}}) {
    Scene scene = with_rectangle(centre_m + c.grain_m);
    const Vec3 way_m = c.grain_m - c.nearest_m;
    const Vec3 expected_N = 1e4 * (1 - way_m.norm()) * way_m.normalized();
    CAPTURE(c.grain_m.transpose());
    CHECK((force_on_grain_N(scene) - expected_N).norm() < 1e-9 * expected_N.norm());
    // action and reaction, and the torque about the wall's point
    CHECK((scene.state.wall_force_N(0) + expected_N).norm() < 1e-9 * expected_N.norm());
    CHECK((scene.state.wall_torque_N_m(0) + c.nearest_m.cross(expected_N)).norm() <
          1e-8 * expected_N.norm());
    CHECK_THAT(wall_distance_m(scene.model, initial_state(scene.model, scene.start_m), 0,
                               centre_m + c.grain_m),
               WithinRel(way_m.norm(), 1e-12));
  }
}

TEST_CASE("walls: beyond the reach of a rectangle's edge there is no force", "[dem_core][walls]") {
  Scene scene = with_rectangle({10 + 3.8, 20, 30.7});
  CHECK(force_on_grain_N(scene) == Vec3::Zero());
}

TEST_CASE("walls: a cylinder pushes towards its axis", "[dem_core][walls]") {
  Scene scene;
  const Vec3 axis = Vec3(1, 1, 0).normalized();
  const Vec3 out = Vec3::UnitZ();
  scene.sphere(Vec3(1, 2, 3) + 7 * axis + 4.2 * out);
  Wall tube;
  tube.shape = WallShape::cylinder;
  tube.direction = axis;
  tube.position_m = {1, 2, 3};
  tube.radius_m = 5;
  scene.model.walls.push_back(tube);
  // 0.2 m of overlap
  CHECK((force_on_grain_N(scene) + 2000 * out).norm() < 1e-8);
}

TEST_CASE("walls: a growing cylinder lets go, a shrinking one pushes", "[dem_core][walls]") {
  for (const double e : {1.0, 0.5})
    for (const double growth_m_per_s : {0.5, -0.5}) {
      Scene scene;
      scene.sphere({4, 0, 0});
      Wall tube;
      tube.shape = WallShape::cylinder;
      tube.radius_m = 5;
      scene.model.walls.push_back(tube);
      scene.law().normal_damping = damping_number(e);
      scene.begin();
      scene.state.drive(0, 0).radial_velocity_m_per_s = growth_m_per_s;
      scene.run(1000);
      CAPTURE(e);
      // from touching at rest, the wall passes on (1 + e) times its speed; 1 %: 314 steps per
      // contact
      CHECK_THAT(scene.state.velocity_m_per_s(0).x(),
                 WithinAbs(growth_m_per_s < 0 ? -0.5 * (1 + e) : 0.0, 1e-2));
    }
}

TEST_CASE("walls: a wall placed into a grain may count from there", "[dem_core][walls]") {
  Scene scene;
  scene.sphere({0, 0, 0.9});
  scene.plane(Vec3::UnitZ());
  scene.model.wall_references.push_back({0, 0, 0.9});
  CHECK(force_on_grain_N(scene) == Vec3::Zero());
  scene.model.wall_references[0].distance_m = 0.95;
  CHECK_THAT(force_on_grain_N(scene).z(), WithinRel(500.0, 1e-9));
}

TEST_CASE("walls: the floor's torque is the moment of the weight", "[dem_core][walls]") {
  Scene scene;
  scene.sphere({3, -2, 1}, 1, 2);
  scene.plane(Vec3::UnitZ(), {1, 1, 0});
  scene.model.gravity_m_per_s2 = {0, 0, -10};
  scene.law().normal_damping = 1;
  scene.law().dt_s = 1e-3;
  scene.begin();
  scene.run(3000);
  const Vec3 expected_N_m = Vec3(2, -3, 0).cross(Vec3(0, 0, -20));
  CHECK((scene.state.wall_torque_N_m(0) - expected_N_m).norm() < 1e-7);
}

TEST_CASE("walls: a servo plate holds its force on a packing", "[dem_core][walls]") {
  Scene scene;
  PackingSpec spec;
  spec.shape = ContainerShape::box;
  spec.size_m = {8, 8, 8};
  spec.num_particles = 80;
  const Packing packing = make_packing(spec);
  for (std::size_t i = 0; i < packing.radius_m.size(); ++i)
    scene.sphere(packing.position_m[i], packing.radius_m[i]);
  scene.model.mass_kg = sphere_masses_kg(scene.model.radius_m, 1.0);
  for (int axis = 0; axis < 3; ++axis) {
    scene.plane(Vec3::Unit(axis));
    scene.plane(-Vec3::Unit(axis), Vec3::Constant(8));
  }
  const int lid = 5;
  scene.law().friction = 0.3;
  scene.law().normal_damping = 0.5;
  scene.law().local_damping = 0.2;
  scene.law().dt_s = 3e-3;
  scene.begin();
  for (const double target_N : {200.0, 500.0, 100.0}) {
    // 1e-4: with the packing's 5 kN/m the plate answers in 2 s, slower than the packing swings (0.5
    // s)
    scene.state.drive(lid, 0) = {
        .servo_gain_m_per_N_s = 1e-4, .target_force_N = target_N, .max_speed_m_per_s = 0.5};
    scene.run(15000);
    CAPTURE(target_N);
    // 1e-3: integral control leaves no offset, only what still rearranges
    CHECK_THAT(scene.state.wall_force_N(lid).z(), WithinRel(target_N, 1e-3));
    CHECK_THAT(scene.state.wall_force_N(lid - 1).z(), WithinRel(-target_N, 1e-2));
  }
}

TEST_CASE("walls: a servo never exceeds its speed", "[dem_core][walls]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  const int lid = scene.plane(-Vec3::UnitZ(), {0, 0, 100});
  scene.begin();
  scene.state.drive(lid, 0) = {
      .servo_gain_m_per_N_s = 1, .target_force_N = 1e3, .max_speed_m_per_s = 0.5};
  scene.run(1000);
  CHECK_THAT(scene.state.wall_position_m(lid).z(), WithinRel(100 - 0.5 * 0.1, 1e-12));
}

TEST_CASE("walls: a moving belt rolls a sphere to 2/7 of its speed and carries a block fully",
          "[dem_core][walls]") {
  const auto on_belt = [](bool block) {
    Scene scene;
    const double z = 1 - 1e-4;
    scene.sphere({0, 0, z});
    if (block) {
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
    }
    const int belt = scene.plane(Vec3::UnitZ());
    scene.model.gravity_m_per_s2 = {0, 0, -1};
    scene.law().wall_friction = 0.5;
    scene.law().normal_damping = 1;
    scene.law().tangential_damping = 0.5;
    scene.law().dt_s = 1e-3;
    scene.begin();
    scene.state.drive(belt, 0).velocity_m_per_s = {0.7, 0, 0};
    scene.run(10000);
    return scene.state.velocity_m_per_s(0).x();
  };
  // the belt's friction acts at the contact point: m d v = I w and v + w d = V
  CHECK_THAT(on_belt(false), WithinRel(0.7 * 2 / 7, 2e-4));  // 2e-4: d = r (1 - 1e-4)
  CHECK_THAT(on_belt(true), WithinRel(0.7, 1e-6));
}

TEST_CASE("walls: a greased wall beside a rough one drags nothing", "[dem_core][walls]") {
  // One sphere between two plates that slide along +y and -y, pressed by 2000 N: what the rough one
  // rubs is friction times scale times the normal force, the greased one rubs nothing.
  for (const double scale : {0.0, 0.5, 1.0}) {
    Scene scene;
    scene.sphere({0, 0, 0.8}, 1.0, testing::fixed_mass_kg);
    const int floor = scene.plane(Vec3::UnitZ());
    const int lid = scene.plane(-Vec3::UnitZ(), {0, 0, 1.6});
    scene.model.walls[static_cast<std::size_t>(floor)].friction_scale = scale;
    scene.model.walls[static_cast<std::size_t>(lid)].friction_scale = 0;
    scene.law().wall_friction = 0.4;
    scene.begin();
    scene.state.drive(floor, 0).velocity_m_per_s = Vec3::UnitY();
    scene.state.drive(lid, 0).velocity_m_per_s = -Vec3::UnitY();
    scene.run(2000);  // 0.2 m of travel; the spring slips after 0.16 m
    CAPTURE(scale);
    // rounding; the grain is too heavy to move
    CHECK_THAT(scene.state.wall_force_N(floor).y(), WithinAbs(-0.4 * scale * 2000, 1e-6));
    CHECK(scene.state.wall_force_N(lid).y() == 0);
    CHECK_THAT(scene.state.wall_force_N(floor).z(), WithinRel(-2000.0, 1e-9));
  }
}

TEST_CASE("walls: a glued grain hangs from its wall", "[dem_core][walls]") {
  Scene scene;
  scene.sphere({0, 0, -1.3}, 1, 2);  // under the plane, with a gap
  const int ceiling = scene.plane(-Vec3::UnitZ());
  scene.model.wall_references.push_back({ceiling, 0, 1.3, true});
  scene.model.gravity_m_per_s2 = {0, 0, -10};
  scene.law().normal_damping = 1;
  scene.law().dt_s = 1e-3;
  scene.begin();
  scene.run(3000);
  // k = 1e4 N/m; 1e-9: the damped swing is gone
  CHECK_THAT(-1.3 - scene.state.position_m(0).z(), WithinRel(20 / 1e4, 1e-9));
  CHECK_THAT(scene.state.wall_force_N(ceiling).z(), WithinRel(-20.0, 1e-9));
  CHECK_THAT(scene.energy_now().walls_J, WithinRel(0.5 * 20 * 20 / 1e4, 1e-9));
  // The stable step knows the glue across the gap (theory/time_step.md, 5): the tangential spring
  // with its lever is the stiffer one, the normal dashpot the only one.
  const double lever_m = -scene.state.position_m(0).z();
  const double k = 0.5e4 * (1.0 / 2 + lever_m * lever_m / (0.4 * 2));
  const double c = std::sqrt(2 * 1e4) / 2;
  CHECK_THAT(stable_time_step_s(scene.model, scene.state, 0),
             WithinRel(4 / (c + std::sqrt(c * c + 4 * k)), 1e-9));
}

TEST_CASE("walls: glue neither slips nor lets go", "[dem_core][walls]") {
  Scene scene;
  scene.sphere({0, 0, 0.9}, 1.0, testing::fixed_mass_kg);
  const int plate = scene.plane(Vec3::UnitZ());
  scene.model.wall_references.push_back({plate, 0, 0.9, true});
  scene.law().wall_friction = 0.01;
  scene.begin();
  scene.state.drive(plate, 0).velocity_m_per_s = {0.7, 0, -2};
  scene.run(2000);
  // 0.14 m aside and 0.4 m away: k_s = 0.5e4 N/m, k_n = 1e4 N/m on a grain that cannot move
  const Vec3 expected_N(-0.5e4 * 0.14, 0, 1e4 * 0.4);
  CHECK((scene.state.wall_force_N(plate) - expected_N).norm() < 1e-9 * expected_N.norm());
}

TEST_CASE("walls: a grain that comes over the rim of an edgeless rectangle meets it at once",
          "[dem_core][walls]") {
  // The list must know the grain while it is still beside, where the wall does not act: it travels
  // 0.05 m, less than the skin of 0.3 m that would have the list made anew.
  Scene scene;
  scene.sphere({-0.05, 0, 0.9});
  Wall shelf;
  shelf.position_m = {3, 0, 0};
  shelf.half_a_m = shelf.half_b_m = 3;
  shelf.has_edges = false;
  scene.model.walls.push_back(shelf);
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {1, 0, 0});
  scene.run(490);  // 0.049 m
  CHECK(scene.state.velocity_m_per_s(0).z() == 0);
  scene.run(30);
  // 20 steps of 1e-4 s under 0.1 m of overlap, 1e4 N/m and 1 kg: v = 0.1 m w sin(w t), w = 100 / s;
  // 10 %: one step more or less
  CHECK(scene.workspace.num_rebuilds == 1);
  CHECK_THAT(scene.state.velocity_m_per_s(0).z(), WithinRel(10 * std::sin(0.2), 0.1));
}
