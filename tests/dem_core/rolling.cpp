// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Rolling resistance: closed forms of one sphere, the law by numbers, invariants, null value.
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "dem_core/contact_law.hpp"
#include "dem_core/snapshot.hpp"
#include "dem_core/time_step.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

namespace {

/// A sphere of 1 m and 1 kg on the plane z = 0, carried at the start by an overlap of 1e-4 m; gravity
/// of 1 m/s2 tilted by the angle; friction large enough not to slip.
Scene sphere_on_plane(double angle_rad, double rolling_friction) {
  Scene scene;
  scene.plane(Vec3::UnitZ());
  scene.model.gravity_m_per_s2 = {std::sin(angle_rad), 0, -std::cos(angle_rad)};
  scene.law().wall_friction = 2.0;
  scene.law().rolling_friction = rolling_friction;
  scene.law().normal_damping = 1.0;
  scene.law().tangential_damping = 0.5;
  scene.law().dt_s = 1e-3;
  scene.sphere({0, 0, 1 - std::cos(angle_rad) / 1e4});
  scene.begin();
  return scene;
}

double height_m(const Scene& scene) { return scene.start_m[0].z(); }

/// m d^2 + I over m d^2 of a sphere whose centre rolls d above the plane.
double rolling_mass(double d_m) { return 1 + 0.4 / (d_m * d_m); }

std::uint64_t hash(const AlignedDoubles& numbers) {
  std::uint64_t h = 1469598103934665603ULL;
  for (const double x : numbers)
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 1099511628211ULL;
  return h;
}

/// 100 grains of two sizes that rain into a box; one lane per rolling friction, another sliding
/// friction each.
Scene rain(const std::vector<double>& rolling_friction, const std::vector<double>& friction) {
  Scene scene;
  int k = 0;
  for (const Vec3& p : testing::scattered_points(100, 10, 2.0, 7))
    scene.sphere(p, ++k % 2 ? 0.95 : 0.7);
  scene.model.mass_kg = sphere_masses_kg(scene.model.radius_m, 0.25);
  scene.model.gravity_m_per_s2 = {0.2, 0.1, -1};
  scene.model.damping_kind = DampingKind::rate;
  for (int axis = 0; axis < 3; ++axis) {
    scene.plane(Vec3::Unit(axis), Vec3::Constant(-1));
    scene.plane(-Vec3::Unit(axis), Vec3::Constant(11));
  }
  scene.law().wall_friction = 0.3;
  scene.law().normal_damping = 20;
  scene.law().tangential_damping = 5;
  scene.law().dt_s = 2e-3;
  scene.set_num_lanes(static_cast<int>(rolling_friction.size()));
  for (std::size_t lane = 0; lane < rolling_friction.size(); ++lane) {
    scene.model.lanes[lane].rolling_friction = rolling_friction[lane];
    scene.model.lanes[lane].friction = friction[lane];
  }
  scene.begin();
  scene.run(4000);
  return scene;
}

std::vector<double> one_lane(const AlignedDoubles& block, std::size_t num_lanes, std::size_t lane) {
  std::vector<double> out;
  for (std::size_t k = lane; k < block.size(); k += num_lanes) out.push_back(block[k]);
  return out;
}

}  // namespace

TEST_CASE("rolling: a sphere on an incline stays below tan(angle) = mu_r and rolls above",
          "[dem_core][rolling]") {
  const double mu_r = 0.3;
  for (const double ratio : {0.5, 0.9, 0.99, 1.01, 1.1, 2.0}) {
    const double angle_rad = std::atan(ratio * mu_r);
    Scene scene = sphere_on_plane(angle_rad, mu_r);
    const double d_m = height_m(scene);
    // While the spring is wound up the sphere gains some 4 mm/s, which it may first roll off (2 s at 0.99).
    scene.run(5000);
    const double early_m_per_s = scene.state.velocity_m_per_s(0).x();
    const double early_m = scene.state.position_m(0).x();
    scene.run(5000);
    // rolling.md, 5: arm r = 1 of the limit against d of the weight, apart by 1e-4
    const double a = std::max(0.0, (std::sin(angle_rad) - mu_r / d_m * std::cos(angle_rad)) /
                                       rolling_mass(d_m));
    CAPTURE(ratio);
    if (ratio > 1) {
      // 1e-6 g: both springs are at rest, the normal one is damped
      CHECK_THAT((scene.state.velocity_m_per_s(0).x() - early_m_per_s) / 5, WithinAbs(a, 1e-6));
    } else {
      // it may rock within the elastic range of its spring, 2 M_max / k_r r = 1.2e-4 m
      CHECK(std::abs(scene.state.position_m(0).x() - early_m) < 1.2e-4);
    }
  }
}

TEST_CASE("rolling: a rolling sphere on a level plane is slowed by 5/7 mu_r g and then stands",
          "[dem_core][rolling]") {
  const double mu_r = 0.1;
  Scene scene = sphere_on_plane(0, mu_r);
  const double d_m = height_m(scene);
  scene.state.set_velocity_m_per_s(0, {1, 0, 0});
  scene.state.set_angular_velocity_rad_per_s(0, {0, 1 / d_m, 0});
  scene.run(5000);
  const double a = mu_r / d_m / rolling_mass(d_m);
  CHECK_THAT(a, WithinRel(5.0 / 7 * mu_r, 1e-4));  // the overlap
  // 1e-4: the spring is wound up over the first 2e-5 rad
  CHECK_THAT(1 - scene.state.velocity_m_per_s(0).x(), WithinRel(5 * a, 1e-4));
  scene.run(15000);
  // it rolls v^2 / 2a = 7 m and stops after 14 s; then it rocks on its rolling spring
  CHECK_THAT(scene.state.position_m(0).x(), WithinRel(0.5 / a, 1e-3));
  CHECK(std::abs(scene.state.velocity_m_per_s(0).x()) < 0.01);
}

TEST_CASE("rolling: the law by numbers", "[dem_core][rolling]") {
  const RollingConstants c{
      .shear_stiffness_N_per_m = 100, .rolling_radius_m = 0.5, .rolling_friction = 0.2, .dt_s = 0.1};
  RollingMotion m{.normal = Vec3::UnitZ(), .normal_N = 10};
  m.spin_b_rad_per_s = {0.2, 0, 0};
  const RollingResponse elastic = rolling_law(c, m, Vec3::Zero());
  CHECK(elastic.angle_rad.isApprox(Vec3(0.02, 0, 0), 1e-15));
  CHECK(elastic.moment_on_a_N_m.isApprox(Vec3(0.5, 0, 0), 1e-15));  // 100 x 0.25 x 0.02
  // mu_r Rbar F_n = 1 N m; the spring is cut back to it
  const RollingResponse plastic = rolling_law(c, m, Vec3(0.3, 0.4, 0));
  CHECK_THAT(plastic.moment_on_a_N_m.norm(), WithinRel(1.0, 1e-14));
  CHECK_THAT(plastic.angle_rad.norm(), WithinRel(1.0 / 25, 1e-14));
  // a pair that pulls cannot resist
  m.normal_N = -1;
  CHECK(rolling_law(c, m, Vec3(0.3, 0.4, 0)).moment_on_a_N_m == Vec3::Zero());
}

TEST_CASE("rolling: neither equal spins nor twisting are resisted", "[dem_core][rolling]") {
  const RollingConstants c{
      .shear_stiffness_N_per_m = 100, .rolling_radius_m = 0.5, .rolling_friction = 0.2, .dt_s = 0.1};
  RollingMotion m{.normal = Vec3::UnitZ(), .normal_N = 10};
  m.spin_a_rad_per_s = m.spin_b_rad_per_s = {3, -2, 0};
  CHECK(rolling_law(c, m, Vec3::Zero()).moment_on_a_N_m == Vec3::Zero());
  m.spin_a_rad_per_s = {0, 0, 5};
  m.spin_b_rad_per_s = {0, 0, -7};
  CHECK(rolling_law(c, m, Vec3::Zero()).moment_on_a_N_m == Vec3::Zero());
  // a wound-up pair that turns as one body about its normal takes its moment along: 10 x 0.01 rad
  const RollingConstants soft{.shear_stiffness_N_per_m = 100,
                              .rolling_radius_m = 0.5,
                              .rolling_friction = 0.2,
                              .dt_s = 0.01};
  m.spin_a_rad_per_s = m.spin_b_rad_per_s = {0, 0, 1};
  Vec3 angle(0.01, 0, 0);
  for (int n = 0; n < 10; ++n) angle = rolling_law(soft, m, angle).angle_rad;
  const Vec3 turned = Eigen::AngleAxisd(0.1, Vec3::UnitZ()) * Vec3(0.01, 0, 0);
  CHECK((angle - turned).norm() < 0.01 * 6e-4);  // w^2 t dt / 2 = 5e-4 of its length, bond.md, 5
}

TEST_CASE("rolling: momentum and angular momentum are kept", "[dem_core][rolling]") {
  Scene scene;
  const std::vector<Vec3> points = testing::scattered_points(40, 7, 1.7, 3);
  for (std::size_t k = 0; k < points.size(); ++k)
    scene.sphere(points[k], k % 3 ? 0.9 : 0.6, k % 3 ? 1.0 : 0.3);
  scene.law().friction = 0.4;
  scene.law().rolling_friction = 0.3;
  scene.law().normal_damping = 0.2;
  scene.begin();
  for (int i = 0; i < scene.model.num_particles(); ++i) {
    scene.state.set_velocity_m_per_s(i, Vec3::Constant(3.5) - points[static_cast<std::size_t>(i)]);
    scene.state.set_angular_velocity_rad_per_s(i, {1.0, -0.1 * i, 0.5});
  }
  const Vec3 p0 = momentum_kg_m_per_s(scene.model, scene.state);
  const Vec3 l0 = angular_momentum_kg_m2_per_s(scene.model, scene.state);
  const double before_J = scene.energy_now().kinetic_J;
  scene.run(20000);
  CHECK(scene.energy_now().total_J() < 0.9 * before_J);  // there were impacts
  // rounding only: 1e-12 of 40 grains' momenta of up to 4 kg m/s and 20 kg m2/s
  CHECK((momentum_kg_m_per_s(scene.model, scene.state) - p0).norm() < 1e-12 * 160);
  CHECK((angular_momentum_kg_m2_per_s(scene.model, scene.state) - l0).norm() < 1e-12 * 800);
}

TEST_CASE("rolling: the wound-up spring is part of the energy", "[dem_core][rolling]") {
  // A sphere rocks on its spring without slip: only semi-implicit Euler's O(dt) may be missing.
  Scene scene = sphere_on_plane(0, 1e3);
  scene.law().normal_damping = scene.law().tangential_damping = 0;
  scene.law().wall_friction = 1e6;
  scene.law().dt_s = 1e-4;
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {0.1, 0, 0});
  scene.state.set_angular_velocity_rad_per_s(0, {0, 0.1 / height_m(scene), 0});
  scene.run(1);
  const Energy start = scene.energy_now();
  double least_kinetic_J = start.kinetic_J;
  double worst_J = 0;
  for (int n = 0; n < 2000; ++n) {
    scene.run(1);
    least_kinetic_J = std::min(least_kinetic_J, scene.energy_now().kinetic_J);
    worst_J = std::max(worst_J, std::abs(scene.energy_now().total_J() - start.total_J()));
  }
  // it did turn round; 5 %: the tangential spring gives way too, so not everything stops at once
  CHECK(least_kinetic_J < 0.05 * start.kinetic_J);
  // omega dt / 2 with omega^2 = k_r / (m d^2 + I) = 5e3 / 1.4: 0.3 %
  CHECK(worst_J < 4e-3 * start.kinetic_J);
}

TEST_CASE("rolling: zero is the baseline bit for bit, alone and beside lanes that roll stiffly",
          "[dem_core][rolling]") {
  // Hash of this bed by the code before rolling resistance existed, commit f13b498.
  const Scene alone = rain({0}, {0.4});
  CHECK(alone.state.contacts.rolling_rad.empty());
  CHECK(alone.state.wall_contacts.rolling_rad.empty());
  CHECK(hash(alone.state.motion) == 0x5920f28126b995d3ULL);
  for (const int w : {4, 8}) {
    if (!lanes_supported(w)) continue;
    std::vector<double> rolling(static_cast<std::size_t>(w)), friction = rolling;
    for (std::size_t k = 0; k < rolling.size(); ++k) {
      rolling[k] = k % 2 ? 0.1 * static_cast<double>(k) : 0.0;
      friction[k] = 0.1 + 0.1 * static_cast<double>(k);
    }
    const Scene together = rain(rolling, friction);
    for (std::size_t k = 0; k < rolling.size(); ++k) {
      CAPTURE(w, k);
      const Scene single = rain({rolling[k]}, {friction[k]});
      CHECK(one_lane(together.state.motion, rolling.size(), k) ==
            one_lane(single.state.motion, 1, 0));
      CHECK(one_lane(together.state.wall_force, rolling.size(), k) ==
            one_lane(single.state.wall_force, 1, 0));
    }
    CHECK(one_lane(together.state.motion, rolling.size(), 0) !=
          one_lane(together.state.motion, rolling.size(), 1));
  }
}

TEST_CASE("rolling: a restart keeps the wound-up springs, a thrown-away workspace too",
          "[dem_core][rolling]") {
  Scene scene = rain({0.3}, {0.4});
  REQUIRE(std::ranges::any_of(scene.state.contacts.rolling_rad, [](double x) { return x != 0; }));
  REQUIRE(
      std::ranges::any_of(scene.state.wall_contacts.rolling_rad, [](double x) { return x != 0; }));
  const auto file = std::filesystem::temp_directory_path() / "tilth_rolling.state";
  save_snapshot(scene.state, file);
  Scene copy = scene;
  copy.state = load_snapshot(file);
  std::filesystem::remove(file);
  copy.workspace = {};
  scene.run(500);
  copy.run(500);
  CHECK(copy.state.motion == scene.state.motion);
}

TEST_CASE("rolling: bonded grains have their bond instead", "[dem_core][rolling]") {
  // Two overlapping bonded grains spin against each other; with rolling friction the same bits, until
  // the bond is gone.
  const auto spun = [](double rolling_friction, double strength) {
    Scene scene;
    scene.sphere({0, 0, 0});
    scene.sphere({1.99, 0, 0});
    scene.bond(0, 1);
    scene.law().bond = {.normal_scale = 1e4,
                        .shear_scale = 5e3,
                        .bending_scale = 1e3,
                        .twisting_scale = 1e3,
                        .tensile_limit = strength,
                        .cohesion_limit = strength};
    scene.law().rolling_friction = rolling_friction;
    scene.begin();
    scene.state.set_angular_velocity_rad_per_s(0, {0, 1, 0});
    scene.run(200);
    return scene.state.motion;
  };
  CHECK(spun(0.5, 1e9) == spun(0, 1e9));
  CHECK(spun(0.5, 0) != spun(0, 0));
}

TEST_CASE("rolling: the stable time step knows the rolling spring", "[dem_core][rolling]") {
  // One grain on a frictional wall: rotation alone has omega^2 = (k_s d^2 + k_r) / I, coupled to u by
  // k_s; with k_r = k_s r^2 the block ((k, k), (k, 2k)) over (m, 2/5 m) has the eigenvalues of
  // ((1, s), (s, 5)) k_s / m, s = sqrt(5/2): 3 + sqrt(4 + 5/2).
  const auto step_s = [](double rolling_friction) {
    Scene scene;
    scene.plane(Vec3::UnitZ());
    scene.sphere({0, 0, 1.0});
    scene.law().shear_stiffness_ratio = 1.0;
    scene.law().rolling_friction = rolling_friction;
    scene.begin();
    return stable_time_step_s(scene.model, scene.state, 0);
  };
  CHECK_THAT(step_s(0.1), WithinRel(2 / std::sqrt(1e4 * (3 + std::sqrt(6.5))), 1e-12));
  CHECK_THAT(step_s(0.0), WithinRel(2 / std::sqrt(1e4 * 3.5), 1e-12));  // ((1, s), (s, 2.5))
}
