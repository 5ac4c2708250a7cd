// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Rigid tools: distances to faces, edges and corners, friction, motion, forces and torques.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "dem_core/snapshot.hpp"
#include "dem_core/time_step.hpp"
#include "experiments/tool_shapes.hpp"
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

/// A box of 6 x 4 x 2 m, turned and moved.
struct PlacedBox {
  Tool tool{.mesh = box_mesh({-3, -2, -1}, {3, 2, 1}),
            .position_m = {5, -7, 2},
            .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};
  Vec3 to_world(const Vec3& x) const { return tool.position_m + tool.orientation * x; }
  Vec3 turned(const Vec3& v) const { return tool.orientation * v; }
};

/// A triangulated plate whose upper face is z = 0; its flat diagonal runs through the origin.
Tool plate(double half_m = 20) {
  return {.mesh = box_mesh({-half_m, -half_m, -5}, {half_m, half_m, 0})};
}

Scene rolling_sphere(bool on_mesh, const Vec3& start_m, const Vec3& velocity_m_per_s) {
  Scene scene;
  scene.sphere(start_m);
  if (on_mesh) scene.model.tools.push_back(plate());
  else scene.plane(Vec3::UnitZ());
  scene.model.gravity_m_per_s2 = {0, 0, -1};
  scene.law().wall_friction = scene.law().tool_friction = 0.5;
  scene.law().normal_damping = 0.5;
  scene.law().tangential_damping = 0.2;
  scene.law().dt_s = 1e-3;
  scene.begin();
  scene.state.set_velocity_m_per_s(0, velocity_m_per_s);
  return scene;
}

}  // namespace

TEST_CASE("tools: faces, edges and corners of a turned box push along the shortest way",
          "[dem_core][tools]") {
  struct Case {
    Vec3 grain_m;    ///< body frame
    Vec3 nearest_m;  ///< point of the box
  };
  const PlacedBox box;
  for (const Case& c : {Case{{1, -1, 1.9}, {1, -1, 1}}, Case{{-3.4, 0.3, 0.2}, {-3, 0.3, 0.2}},
                        Case{{3.5, 1, 1.6}, {3, 1, 1}}, Case{{0.4, 2.3, -1.7}, {0.4, 2, -1}},
                        Case{{3.4, -2.3, 1.5}, {3, -2, 1}}, Case{{-3.1, 2.2, -1.3}, {-3, 2, -1}},
                        Case{{0, 0, -1.5}, {0, 0, -1}}}) {
    Scene scene;
    scene.sphere(box.to_world(c.grain_m));
    scene.model.tools.push_back(box.tool);
    const Vec3 way_m = box.turned(c.grain_m - c.nearest_m);
    const Vec3 expected_N = 1e4 * (1 - way_m.norm()) * way_m.normalized();
    CAPTURE(c.grain_m.transpose());
    // 1e-9: rounding of the turn and of a force from a momentum
    CHECK((force_on_grain_N(scene) - expected_N).norm() < 1e-9 * expected_N.norm());
    CHECK((scene.state.tool_force_N(0) + expected_N).norm() < 1e-9 * expected_N.norm());
    const Vec3 torque_N_m = -box.turned(c.nearest_m).cross(expected_N);
    CHECK((scene.state.tool_torque_N_m(0) - torque_N_m).norm() < 1e-8 * expected_N.norm());
    CHECK(scene.state.num_tool_contacts(0) == 1);
  }
}

TEST_CASE("tools: out of reach there is no force, on any side", "[dem_core][tools]") {
  const PlacedBox box;
  for (const Vec3& x : {Vec3(0, 0, 2.001), Vec3(3.72, 2.72, 0), Vec3(3.6, 2.6, 1.6)}) {
    Scene scene;
    scene.sphere(box.to_world(x));
    scene.model.tools.push_back(box.tool);
    CHECK(force_on_grain_N(scene) == Vec3::Zero());
    CHECK(scene.state.num_tool_contacts(0) == 0);
  }
}

TEST_CASE("tools: seen from outside a face, a box of twelve triangles is its plane, to the last bit",
          "[dem_core][tools]") {
  // Unturned and at the origin, so that the frames agree bit for bit. Dropped, rolling, bouncing.
  Scene mesh = rolling_sphere(true, {-3, 4, 1.2}, {0.3, 0.9, -0.4});
  Scene plane = rolling_sphere(false, {-3, 4, 1.2}, {0.3, 0.9, -0.4});
  for (int n = 0; n < 4000; ++n) {  // until (-1.8, 7.6): it stays on one triangle
    mesh.run(1);
    plane.run(1);
  }
  CHECK(mesh.state.motion == plane.state.motion);
  CHECK(mesh.state.tool_force_N(0) == plane.state.wall_force_N(0));
}

TEST_CASE("tools: a sphere rolling over a flat diagonal feels no bump", "[dem_core][tools]") {
  // It rolls without slip from the start, across x = y and, in the second case, along it.
  for (const Vec3& v : {Vec3(1, -0.3, 0), Vec3(1, 1, 0)}) {
    const Vec3 start_m = -2 * v + Vec3(0, 0, 1 - 1e-4);
    Scene scene = rolling_sphere(true, start_m, v);
    scene.law().tool_friction = 0;  // the spring is one per triangle; here only the normal matters
    const double z = scene.state.position_m(0).z();
    for (int n = 0; n < 4000; ++n) {
      scene.run(1);
      // one triangle at a time, weight 1 N; 1e-9: rounding of 1e4 N/m x 1 m
      REQUIRE(scene.state.num_tool_contacts(0) == 1);
      REQUIRE_THAT(scene.state.tool_force_N(0).z(), WithinAbs(-1.0, 1e-9));
      REQUIRE_THAT(scene.state.position_m(0).z(), WithinAbs(z, 1e-12));
    }
    CHECK((scene.state.position_m(0) - start_m - 4 * v).norm() < 1e-9);
  }
}

TEST_CASE("tools: in a concave corner both faces push", "[dem_core][tools]") {
  Scene scene;
  const Mesh l = prism_mesh({{0, 0}, {6, 0}, {6, 3}, {3, 3}, {3, 6}, {0, 6}}, -5, 5);
  scene.model.tools.push_back({.mesh = l});
  scene.sphere({3.9, 3.8, 0.5});
  const Vec3 expected_N(1e4 * 0.1, 1e4 * 0.2, 0);
  CHECK((force_on_grain_N(scene) - expected_N).norm() < 1e-9 * expected_N.norm());
  CHECK(scene.state.num_tool_contacts(0) == 2);
}

TEST_CASE("tools: a block slides on a turned mesh plate at tan(angle) = friction",
          "[dem_core][tools]") {
  const double friction = 0.4;
  for (const double ratio : {0.9, 0.98, 1.02, 1.5}) {
    const double angle_rad = std::atan(ratio * friction);
    Scene scene;
    // Here the plate is inclined, gravity vertical: downhill is (cos, 0, -sin).
    Tool tool = plate(60);
    tool.orientation = Eigen::AngleAxisd(angle_rad, Vec3::UnitY());
    scene.model.tools.push_back(tool);
    const double z = 1 - std::cos(angle_rad) / 1e4;
    const Vec3 downhill = tool.orientation * Vec3::UnitX();
    for (const Vec3& p : {Vec3(3, -9, z), Vec3(5.5, -7.6, z), Vec3(5.5, -10.4, z)})
      scene.sphere(tool.orientation * p);
    scene.bond(0, 1);
    scene.bond(0, 2);
    scene.bond(1, 2);
    scene.law().bond = {.normal_scale = 1e5,
                        .shear_scale = 1e5,
                        .bending_scale = 1e5,
                        .twisting_scale = 1e5,
                        .tensile_limit = 1e9,
                        .cohesion_limit = 1e9};
    scene.model.gravity_m_per_s2 = {0, 0, -1};
    scene.law().tool_friction = friction;
    scene.law().normal_damping = 1.0;
    scene.law().tangential_damping = 0.5;
    scene.law().dt_s = 1e-3;
    scene.begin();
    scene.run(5000);
    const double early = scene.state.velocity_m_per_s(0).dot(downhill);
    scene.run(5000);
    const double a = (scene.state.velocity_m_per_s(0).dot(downhill) - early) / 5;
    const double closed_form = std::max(0.0, std::sin(angle_rad) - friction * std::cos(angle_rad));
    CAPTURE(ratio);
    CHECK_THAT(a, WithinAbs(closed_form, 1e-6));  // what the damped rocking leaves, as on a plane
    // three grains carry the weight of 3 N
    CHECK_THAT(scene.state.tool_force_N(0).dot(tool.orientation * Vec3::UnitZ()),
               WithinRel(-3 * std::cos(angle_rad), 1e-6));
  }
}

TEST_CASE("tools: what the tool receives is what the grains lose, force and torque",
          "[dem_core][tools]") {
  Scene scene;
  for (const Vec3& p : testing::scattered_points(60, 9, 1.6, 3))
    scene.sphere(p - Vec3::Constant(4.5) + Vec3(0, 0, 5), 0.8);
  scene.model.tools.push_back(
      {.mesh = vane_mesh(8, 5, 0.5), .position_m = {0.3, -0.2, 1}, .max_depth_m = 0.2});
  scene.law().tool_friction = 0.4;
  scene.law().friction = 0.4;
  scene.law().normal_damping = 0.3;
  scene.law().dt_s = 1e-3;
  scene.begin();
  scene.state.tool_drive(0, 0) = {{0.2, -0.1, 0.6}, {0.3, -0.2, 1.5}};
  Vec3 impulse = Vec3::Zero(), turning = Vec3::Zero();
  const Vec3 p0 = momentum_kg_m_per_s(scene.model, scene.state);
  const Vec3 l0 = angular_momentum_kg_m2_per_s(scene.model, scene.state);
  int touched = 0;
  for (int n = 0; n < 2000; ++n) {
    scene.run(1);
    const Vec3 f = scene.state.tool_force_N(0);
    impulse += scene.law().dt_s * f;
    turning += scene.law().dt_s *
               (scene.state.tool_torque_N_m(0) + scene.state.tool_position_m(0).cross(f));
    touched = std::max(touched, scene.state.num_tool_contacts(0));
  }
  REQUIRE(touched > 5);
  const Vec3 p = momentum_kg_m_per_s(scene.model, scene.state);
  const Vec3 l = angular_momentum_kg_m2_per_s(scene.model, scene.state);
  CHECK((p - p0 + impulse).norm() < 1e-10 * p.norm());  // rounding of 2000 sums
  CHECK((l - l0 + turning).norm() < 1e-10 * l.norm());
}

TEST_CASE("tools: a turning disc drags a sphere on it until the contact no longer slides",
          "[dem_core][tools]") {
  Scene scene;
  const double omega = 0.2;  // rad/s
  scene.sphere({3, 0, 1 - 1e-4});
  scene.model.tools.push_back({.mesh = revolution_mesh({{0, -1}, {8, -1}, {8, 0}, {0, 0}}, 24)});
  scene.model.gravity_m_per_s2 = {0, 0, -1};
  scene.law().tool_friction = 0.5;
  scene.law().normal_damping = 1;
  scene.law().tangential_damping = 0.5;
  scene.law().dt_s = 1e-3;
  scene.begin();
  scene.state.tool_drive(0, 0).angular_velocity_rad_per_s = {0, 0, omega};
  scene.run(5000);
  const Vec3 x = scene.state.position_m(0);
  const Vec3 contact_m = x - Vec3(0, 0, x.z());
  const Vec3 surface = Vec3(0, 0, omega).cross(contact_m);
  const Vec3 grain = scene.state.velocity_m_per_s(0) +
                     scene.state.angular_velocity_rad_per_s(0).cross(contact_m - x);
  // A sphere rolling on a turntable moves with 2/7 of it; 1e-3: the spring still carries the
  // centripetal force and is renewed from one triangle to the next.
  CHECK((grain - surface).norm() < 1e-3 * surface.norm());
  CHECK_THAT(scene.state.velocity_m_per_s(0).norm(), WithinRel(2.0 / 7 * omega * 3, 0.02));
  // the disc has turned by one radian
  CHECK_THAT(Eigen::AngleAxisd(scene.state.tool_orientation(0)).angle(), WithinRel(1.0, 1e-9));
}

TEST_CASE("tools: a falling tool gives a sphere (1 + e) times its speed", "[dem_core][tools]") {
  for (const double e : {1.0, 0.5}) {
    Scene scene;
    scene.sphere({0, 0, 0});
    // Far enough that only the tool's own motion brings the pair onto the list.
    scene.model.tools.push_back({.mesh = box_mesh({-2, -2, 0}, {2, 2, 1}), .position_m = {0, 0, 2}});
    scene.law().normal_damping = damping_number(e);
    scene.begin();
    scene.state.tool_drive(0, 0).velocity_m_per_s = {0, 0, -0.5};
    scene.run(21000);
    // 1 %: 314 steps per contact
    CHECK_THAT(scene.state.velocity_m_per_s(0).z(), WithinAbs(-0.5 * (1 + e), 1e-2));
  }
}

TEST_CASE("tools: a turning blade finds a sphere that lay out of reach", "[dem_core][tools]") {
  Scene scene;
  scene.sphere({0, 6, 0});
  scene.model.tools.push_back({.mesh = box_mesh({0, -0.2, -3}, {8, 0.2, 3})});
  scene.begin();
  scene.state.tool_drive(0, 0).angular_velocity_rad_per_s = {0, 0, 0.5};
  scene.run(25000);  // 1.25 rad; the blade's face meets the sphere at atan2(6, 0) - asin(1.2 / 6)
  CHECK(scene.state.num_tool_contacts(0) == 0);
  CHECK(scene.state.velocity_m_per_s(0) == Vec3::Zero());
  scene.run(6000);
  // hit at 1.37 rad, 5.88 m from the axis, and thrown with twice the face's speed; 2 %: the face turns
  // 1.6e-2 rad during the contact
  CHECK_THAT(scene.state.velocity_m_per_s(0).norm(), WithinRel(2 * 0.5 * 5.88, 2e-2));
}

TEST_CASE("tools: an elastic sphere thrown at a tool at rest keeps its energy", "[dem_core][tools]") {
  Scene scene;
  scene.sphere({3.3, 0.2, 3.0});
  scene.model.tools.push_back({.mesh = box_mesh({-3, -2, -1}, {3, 2, 1})});
  scene.law().tool_friction = 0;
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {0, 0, -2});  // onto an edge
  const double before_J = scene.energy_now().total_J();
  double stored_J = 0;
  for (int n = 0; n < 8000; ++n) {
    scene.run(1);
    stored_J = std::max(stored_J, scene.energy_now().tools_J);
    // 1e-2: semi-implicit Euler's ripple is omega dt / 2 = 0.5 %, see collision.cpp
    REQUIRE_THAT(scene.energy_now().total_J(), WithinRel(before_J, 1e-2));
  }
  CHECK(stored_J > 1);
  CHECK(scene.state.velocity_m_per_s(0).x() > 0.5);
}

TEST_CASE("tools: a grain whose centre is further than max_depth behind a face is let go",
          "[dem_core][tools]") {
  for (const double depth_m : {0.1, 0.3}) {
    Scene scene;
    scene.sphere({0, 0, -depth_m});
    Tool tool = plate();
    tool.max_depth_m = 0.2;
    scene.model.tools.push_back(tool);
    const Vec3 f = force_on_grain_N(scene);
    CHECK_THAT(f.z(), WithinRel(depth_m < 0.2 ? 1e4 * (1 + depth_m) : 0.0, 1e-9));
  }
}

TEST_CASE("tools: a reference distance carries no force until the grain comes nearer",
          "[dem_core][tools]") {
  Scene scene;
  scene.sphere({0, 0, 0.9});
  scene.model.tools.push_back(plate());
  scene.model.tool_references = {{0, 0, 0.9}};
  CHECK(force_on_grain_N(scene) == Vec3::Zero());
  scene.start_m[0].z() = 0.85;
  CHECK_THAT(force_on_grain_N(scene).z(), WithinRel(1e4 * 0.05, 1e-9));
}

TEST_CASE("tools: a tool counts for the stable time step as a wall does", "[dem_core][tools]") {
  const Scene mesh = rolling_sphere(true, {0, 0, 1}, Vec3::Zero());
  const Scene plane = rolling_sphere(false, {0, 0, 1}, Vec3::Zero());
  CHECK(stable_time_step_s(mesh.model, mesh.state) == stable_time_step_s(plane.model, plane.state));
}

TEST_CASE("tools: broken meshes are refused", "[dem_core][tools]") {
  Scene scene;
  scene.model.tools.push_back(plate());
  scene.model.tools[0].mesh.triangle.pop_back();
  REQUIRE(problems(scene.model).size() == 3);
  CHECK_THAT(problems(scene.model)[0], Catch::Matchers::StartsWith("tool 0: edge"));
}
