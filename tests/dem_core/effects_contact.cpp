// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Laws beyond the baseline at one contact: closed forms, signs, energy balances.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

namespace {

constexpr double stiffness_N_per_m = 1e4;  // of Scene
constexpr double radius_m = 1.0;
const double area_m2 = std::numbers::pi * radius_m * radius_m;

/// Two grains of 1 m and 1 kg along x, placed by hand before every step.
struct Pair {
  Scene scene;
  explicit Pair(const EffectLaw& effects, double friction = 0.0) {
    scene.sphere({0, 0, 0});
    scene.sphere({2, 0, 0});
    scene.law().effects = effects;
    scene.law().friction = friction;
    scene.begin();
  }
  /// Force on the right grain along x at this overlap, positive pushes apart.
  double push_N(double overlap_m, double sideways_m_per_s = 0.0) {
    scene.state.set_position_m(0, {0, 0, 0});
    scene.state.set_position_m(1, {2 * radius_m - overlap_m, 0, 0});
    scene.state.set_velocity_m_per_s(0, Vec3::Zero());
    scene.state.set_velocity_m_per_s(1, {0, sideways_m_per_s, 0});
    for (const int i : {0, 1}) scene.state.set_angular_velocity_rad_per_s(i, Vec3::Zero());
    scene.run(1);
    return scene.state.velocity_m_per_s(1).x() / scene.law().dt_s;
  }
  /// Work done on the pair along a path of overlaps, by trapezoids.
  double work_J(double from_m, double to_m, int num_steps = 2000) {
    double sum_J = 0.0;
    double before_N = push_N(from_m);
    for (int n = 1; n <= num_steps; ++n) {
      const double now_N = push_N(from_m + (to_m - from_m) * n / num_steps);
      sum_J += 0.5 * (before_N + now_N) * (to_m - from_m) / num_steps;
      before_N = now_N;
    }
    return sum_J;
  }
};

/// Head-on impact of two grains at 0.1 m/s each; speed of separation over speed of approach.
double restitution(const EffectLaw& effects, double dt_s) {
  Scene scene;
  scene.sphere({-1.001, 0, 0});
  scene.sphere({1.001, 0, 0});
  scene.law().effects = effects;
  scene.law().dt_s = dt_s;
  scene.begin();
  scene.state.set_velocity_m_per_s(0, {0.1, 0, 0});
  scene.state.set_velocity_m_per_s(1, {-0.1, 0, 0});
  const double start_J = scene.energy_now().kinetic_J;
  scene.run(static_cast<int>(0.2 / dt_s));
  REQUIRE(scene.state.velocity_m_per_s(1).x() > 0);
  return std::sqrt(scene.energy_now().kinetic_J / start_J);
}

}  // namespace

TEST_CASE("Pressure-dependent stiffness: m = 1/3 is Hertz, and k_0 is the tangent at F_ref",
          "[dem_core][effects]") {
  const double reference_Pa = 50;
  Pair pair({.stiffness_exponent = 1.0 / 3, .reference_pressure_Pa = reference_Pa});
  const double f1_N = pair.push_N(0.01);
  // rounding of the velocities
  REQUIRE_THAT(pair.push_N(0.02) / f1_N, WithinRel(std::pow(2.0, 1.5), 1e-9));
  const double reference_N = reference_Pa * area_m2;
  REQUIRE_THAT(f1_N, WithinRel(reference_N * std::pow(2.0 / 3 * stiffness_N_per_m * 0.01 / reference_N, 1.5),
                               1e-9));
  // F = F_ref at k_0 d = F_ref / (1 - m)
  const double d_m = reference_N / stiffness_N_per_m * 1.5;
  REQUIRE_THAT(pair.push_N(d_m), WithinRel(reference_N, 1e-9));
  const double h_m = 1e-4 * d_m;
  // central difference: h^2 F'''/ (6 F') is below 1e-8 here
  REQUIRE_THAT((pair.push_N(d_m + h_m) - pair.push_N(d_m - h_m)) / (2 * h_m),
               WithinRel(stiffness_N_per_m, 1e-6));
}

TEST_CASE("Pressure-dependent stiffness: softer below the reference, stiffer above, and cut",
          "[dem_core][effects]") {
  Pair pair({.stiffness_exponent = 1.0 / 3, .reference_pressure_Pa = 50});
  REQUIRE(pair.push_N(1e-3) < 0.6 * stiffness_N_per_m * 1e-3);
  REQUIRE(pair.push_N(0.2) > 1.5 * stiffness_N_per_m * 0.2);
  REQUIRE(stiffening_factor(1.0 / 3, 1e9) == 4.0);
  REQUIRE(stiffening_factor(1.0 / 3, 0.0) == 1e-3);
}

TEST_CASE("Pressure-dependent stiffness is reversible", "[dem_core][effects]") {
  Pair pair({.stiffness_exponent = 1.0 / 3, .reference_pressure_Pa = 50});
  const double in_J = pair.work_J(0, 0.05);
  REQUIRE_THAT(pair.work_J(0.05, 0), WithinRel(-in_J, 1e-9));
}

TEST_CASE("Plastic contact: loads with k, unloads with k / (1 - lambda), remembers, forgets on separation",
          "[dem_core][effects]") {
  const double lambda = 0.7;
  const double most_m = 0.02;
  Pair pair({.contact_plasticity = lambda});
  const auto k_d = [](double d_m) { return stiffness_N_per_m * d_m; };
  REQUIRE_THAT(pair.push_N(0.5 * most_m), WithinRel(k_d(0.5 * most_m), 1e-9));
  REQUIRE_THAT(pair.push_N(most_m), WithinRel(k_d(most_m), 1e-9));
  const double slope = (pair.push_N(most_m) - pair.push_N(0.9 * most_m)) / (0.1 * most_m);
  REQUIRE_THAT(slope, WithinRel(stiffness_N_per_m / (1 - lambda), 1e-9));
  REQUIRE_THAT(pair.push_N(lambda * most_m), WithinAbs(0, 1e-9 * k_d(most_m)));
  REQUIRE(pair.push_N(0.5 * most_m) == 0);  // never pulls
  REQUIRE_THAT(pair.push_N(most_m), WithinRel(k_d(most_m), 1e-9));
  REQUIRE_THAT(pair.push_N(1.5 * most_m), WithinRel(k_d(1.5 * most_m), 1e-9));
  pair.push_N(-1e-3);
  REQUIRE_THAT(pair.push_N(0.1 * most_m), WithinRel(k_d(0.1 * most_m), 1e-9));
}

TEST_CASE("Plastic contact: a closed loop loses lambda of the work put in", "[dem_core][effects]") {
  for (const double lambda : {0.3, 0.9}) {
    Pair pair({.contact_plasticity = lambda});
    const double in_J = pair.work_J(0, 0.02);
    const double back_J = -pair.work_J(0.02, 0);
    REQUIRE_THAT(in_J, WithinRel(0.5 * stiffness_N_per_m * 0.02 * 0.02, 1e-9));
    // one trapezoid spans the corner at lambda d: of second order in the 2000 steps
    REQUIRE_THAT(in_J - back_J, WithinRel(lambda * in_J, 1e-4));
  }
}

TEST_CASE("Plastic contact: an impact rebounds with sqrt(1 - lambda), ever closer with a smaller step",
          "[dem_core][effects]") {
  const double expected = std::sqrt(1 - 0.64);
  const double coarse = std::abs(restitution({.contact_plasticity = 0.64}, 4e-4) - expected);
  const double fine = std::abs(restitution({.contact_plasticity = 0.64}, 1e-5) - expected);
  REQUIRE(fine < 2e-3);  // first order: the step at the turning point
  REQUIRE(fine < 0.3 * coarse + 1e-4);
}

TEST_CASE("Crushable aggregates: the force stays below sigma_a A and unloads elastically",
          "[dem_core][effects]") {
  const double strength_Pa = 30;
  Pair pair({.crushing_compliance_per_Pa = 1 / strength_Pa});
  const double most_N = strength_Pa * area_m2;
  const double yield_m = most_N / stiffness_N_per_m;
  REQUIRE_THAT(pair.push_N(0.5 * yield_m), WithinRel(0.5 * most_N, 1e-9));
  REQUIRE_THAT(pair.push_N(3 * yield_m), WithinRel(most_N, 1e-9));
  REQUIRE_THAT(pair.push_N(2.5 * yield_m), WithinRel(0.5 * most_N, 1e-9));
  REQUIRE(pair.push_N(1.5 * yield_m) == 0);
}

TEST_CASE("Capillary cohesion: F_0 = c (4 Rbar)^2 at touch, falling to nothing at a tenth of the radius",
          "[dem_core][effects]") {
  const double c_Pa = 12;
  Pair pair({.capillary_Pa = c_Pa});
  const double touch_N = c_Pa * 4 * radius_m * radius_m;
  REQUIRE_THAT(pair.push_N(-1e-9), WithinRel(-touch_N, 1e-6));
  REQUIRE_THAT(pair.push_N(-0.05), WithinRel(-0.5 * touch_N, 1e-9));
  REQUIRE(pair.push_N(-0.1001) == 0);
  REQUIRE_THAT(pair.push_N(0.01), WithinRel(stiffness_N_per_m * 0.01 - touch_N, 1e-9));
  // The bridge is worth F_0 D / 2.
  REQUIRE_THAT(pair.work_J(-1e-12, -0.1), WithinRel(0.5 * touch_N * 0.1, 1e-3));
}

TEST_CASE("Capillary cohesion: grains escape when they are faster than the bridge holds",
          "[dem_core][effects]") {
  const double c_Pa = 12;
  const double bridge_J = 0.5 * c_Pa * 4 * 0.1;
  for (const double share : {0.98, 1.02}) {
    Scene scene;
    scene.sphere({-1, 0, 0});
    scene.sphere({1, 0, 0});
    scene.law().effects.capillary_Pa = c_Pa;
    scene.begin();
    const double speed = std::sqrt(share * bridge_J);  // both: m v^2 = energy, m = 1 kg
    scene.state.set_velocity_m_per_s(0, {-speed, 0, 0});
    scene.state.set_velocity_m_per_s(1, {speed, 0, 0});
    scene.run(20000);
    const double gap_m =
        (scene.state.position_m(1) - scene.state.position_m(0)).norm() - 2 * radius_m;
    if (share > 1) REQUIRE(gap_m > 0.1);
    else REQUIRE(gap_m < 0.1);
    REQUIRE(momentum_kg_m_per_s(scene.model, scene.state).norm() < 1e-12);
  }
}

TEST_CASE("Capillary cohesion adds to what Coulomb holds", "[dem_core][effects]") {
  // A touching pair under no load is pressed together by its bridge: it resists up to mu F_0.
  const double c_Pa = 12;
  const double held_m = c_Pa * 4 / stiffness_N_per_m;  // k d = F_0: no net force
  Pair pair({.capillary_Pa = c_Pa}, 0.5);
  double sideways_N = 0.0;
  for (int n = 0; n < 600; ++n) {
    pair.push_N(held_m, 0.1);
    sideways_N = (0.1 - pair.scene.state.velocity_m_per_s(1).y()) / pair.scene.law().dt_s;
  }
  REQUIRE_THAT(sideways_N, WithinRel(0.5 * c_Pa * 4, 1e-6));
}

TEST_CASE("Capillary cohesion acts where a bond has gone, not beside one", "[dem_core][effects]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.sphere({2, 0, 0});
  scene.bond(0, 1);
  scene.law().bond = {.normal_scale = 1e3, .tensile_limit = 1e9, .cohesion_limit = 1e9};
  scene.law().effects.capillary_Pa = 12;
  scene.begin();
  scene.run(1);
  REQUIRE(scene.state.velocity_m_per_s(1).x() == 0);
  scene.state.bonds[7] = 0;
  scene.run(1);
  REQUIRE(scene.state.velocity_m_per_s(1).x() < 0);
}

TEST_CASE("Bond healing: the strength of a contact rises with its age and is lost with it",
          "[dem_core][effects]") {
  const double h_Pa = 7;
  Pair pair({.healing_Pa = h_Pa, .healing_time_s = 0.01});
  const double whole_N = h_Pa * area_m2;
  double now_N = 0.0;
  for (int n = 0; n < 100; ++n) now_N = pair.push_N(1e-3);  // 100 steps of 1e-4 s: one t_h
  REQUIRE_THAT(stiffness_N_per_m * 1e-3 - now_N, WithinRel(whole_N * (1 - std::exp(-1.0)), 1e-6));
  pair.push_N(-0.2);
  REQUIRE_THAT(stiffness_N_per_m * 1e-3 - pair.push_N(1e-3), WithinRel(whole_N * -std::expm1(-0.01), 1e-6));
}

namespace {

/// A grain of 1 kg on a floor that sticks, pressed by gravity 10 m/s2 times `weight`, pulled along x.
Vec3 moved_m(double weight, double pull_N, double adhesion_Pa, bool on_tool) {
  Scene scene;
  scene.sphere({0, 0, radius_m});
  if (on_tool) {
    Tool plate;
    plate.mesh.vertex_m = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0},
                           {-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}};
    plate.mesh.triangle = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}, {0, 4, 5}, {0, 5, 1},
                           {1, 5, 6}, {1, 6, 2}, {2, 6, 7}, {2, 7, 3}, {3, 7, 4}, {3, 4, 0}};
    plate.max_depth_m = 1;
    scene.model.tools = {plate};
  } else {
    scene.plane(Vec3::UnitZ());
    scene.model.walls.front().adhesion_scale = 1;
  }
  scene.model.gravity_m_per_s2 = {pull_N, 0, -10 * weight};
  scene.law().wall_friction = scene.law().tool_friction = 0.3;
  scene.law().effects.tool_adhesion_Pa = adhesion_Pa;
  scene.law().local_damping = 0.5;
  scene.law().dt_s = 1e-3;
  scene.law().rolling_friction = on_tool ? 0.0 : 100.0;  // it shall slide, not roll
  scene.begin();
  for (int n = 0; n < 3000; ++n) {
    scene.state.set_angular_velocity_rad_per_s(0, Vec3::Zero());
    scene.run(1);
  }
  return scene.state.position_m(0) - Vec3(0, 0, radius_m);
}

}  // namespace

TEST_CASE("Tool adhesion: slides above mu N + c_a A, leaves above the pull-off, on walls and tools alike",
          "[dem_core][effects]") {
  const double c_Pa = 2;
  const double grip_N = c_Pa * tool_area_over_radius2 * radius_m * radius_m;
  for (const bool on_tool : {false, true}) {
    INFO("on a tool: " << on_tool);
    const double limit_N = 0.3 * 10 + grip_N;
    REQUIRE(moved_m(1, 0.95 * limit_N, c_Pa, on_tool).x() < 0.01);
    REQUIRE(moved_m(1, 1.05 * limit_N, c_Pa, on_tool).x() > 0.1);
    REQUIRE(moved_m(1, 0.95 * limit_N, 0, on_tool).x() > 0.1);
    REQUIRE(moved_m(-0.095 * grip_N, 0, c_Pa, on_tool).z() < 0.01);
    REQUIRE(moved_m(-0.11 * grip_N, 0, c_Pa, on_tool).z() > 0.1);
  }
}

TEST_CASE("Tool adhesion: force and reaction balance", "[dem_core][effects]") {
  Scene scene;
  scene.sphere({0, 0, radius_m + 0.05});  // half the reach of the pull
  scene.plane(Vec3::UnitZ());
  scene.model.walls.front().adhesion_scale = 1;
  scene.law().effects.tool_adhesion_Pa = 2;
  scene.begin();
  scene.run(1);
  const double pull_N = 0.5 * 2 * tool_area_over_radius2;
  REQUIRE_THAT(scene.state.velocity_m_per_s(0).z(), WithinRel(-pull_N * scene.law().dt_s, 1e-9));
  REQUIRE_THAT(scene.state.wall_force_N(0).z(), WithinRel(pull_N, 1e-9));
}

TEST_CASE("Effects: numbers out of range are problems of the model", "[dem_core][effects]") {
  REQUIRE(problems(EffectLaw{}).empty());
  REQUIRE(problems(EffectLaw{.bond_softening = -1}).size() == 1);
  REQUIRE(problems(EffectLaw{.rate_reference_per_s = 0}).size() == 1);
  REQUIRE(problems(EffectLaw{.contact_plasticity = 1}).size() == 1);
  REQUIRE(problems(EffectLaw{.stiffness_exponent = 0.95}).size() == 1);
}
