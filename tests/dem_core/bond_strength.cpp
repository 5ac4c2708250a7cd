// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The displacement at which one bond breaks in a run of the engine, both grains led by hand.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using tilth::testing::fixed_mass_kg;
using tilth::testing::Scene;

namespace {

constexpr double pi = 3.141592653589793;
constexpr BondMaterial soil{.modulus_Pa = 1e4,
                            .stiffness_ratio = 2.5,
                            .tensile_strength_Pa = 1.0,
                            .cohesion_Pa = 2.0,
                            .friction_angle_rad = 0.6,
                            .radius_multiplier = 0.8,
                            .moment_contribution = 0.7};
constexpr double length_m = 2.0;
constexpr double bond_radius_m = 0.8;
constexpr double step_m = 1e-7;  ///< led by this per step; also the turn in rad
constexpr double dt_s = 1e-3;    ///< so short that the bond cannot slow the heavy grains

/// Number of steps the bond survives when the second grain moves and turns as given per step.
int steps_to_break(const Vec3& move, const Vec3& turn_rad, double squeezed_m = 0) {
  Scene scene;
  scene.model.contact_beside_bond = false;
  scene.law().dt_s = dt_s;
  scene.law().bond = bond_law(soil);
  scene.sphere({0, 0, 0}, 1, fixed_mass_kg);
  scene.sphere({0, 0, length_m - squeezed_m}, 1, fixed_mass_kg);
  scene.model.bonds.push_back(parallel_bond(0, 1, 1, 1, length_m));
  scene.begin();
  scene.state.set_velocity_m_per_s(1, move * step_m / dt_s);
  scene.state.set_angular_velocity_rad_per_s(1, turn_rad * step_m / dt_s);
  int n = 0;
  for (; scene.state.bond_holds(0) && n < 100000; ++n) scene.run(1);
  return n;
}

/// Forces see the position before and the rates within a step: the breaking step is the closed form
/// to one step, plus one step for the position.
const double tolerance_steps = 2.0;

}  // namespace

TEST_CASE("bond strength: tension breaks at the strain sigma_c / E", "[dem_core][bond]") {
  const double stretch_m = 1.0 / 1e4 * length_m;
  CHECK_THAT(steps_to_break(Vec3::UnitZ(), Vec3::Zero()),
             WithinAbs(stretch_m / step_m, tolerance_steps));
}

TEST_CASE("bond strength: shear breaks at c / G, and later under compression", "[dem_core][bond]") {
  const double shear_modulus_Pa = 1e4 / 2.5;
  for (const double pressure_Pa : {0.0, 1.0, 5.0}) {
    const double strength_Pa = 2.0 + pressure_Pa * std::tan(0.6);
    const double slide_m = strength_Pa / shear_modulus_Pa * length_m;
    CAPTURE(pressure_Pa);
    CHECK_THAT(steps_to_break(Vec3::UnitX(), Vec3::Zero(), pressure_Pa / 1e4 * length_m),
               WithinAbs(slide_m / step_m, 0.002 * slide_m / step_m));
    // 2e-3: the slide of up to 1.3e-3 L lengthens the bond by 1e-6 L, sigma / E being 5e-4
  }
}

TEST_CASE("bond strength: bending breaks where beta M R / I = sigma_c", "[dem_core][bond]") {
  const double angle_rad = 1.0 / 1e4 * length_m / bond_radius_m / 0.7;
  // turning one grain about its centre also shears the bond by half its length times the angle:
  // 3.6e-4 x 4e3 / 2 = 0.7 Pa of 2 Pa, so bending comes first
  CHECK_THAT(steps_to_break(Vec3::Zero(), Vec3::UnitY()),
             WithinAbs(angle_rad / step_m, tolerance_steps));
}

TEST_CASE("bond strength: torsion breaks where beta M R / J = c", "[dem_core][bond]") {
  const double angle_rad = 2.0 / (1e4 / 2.5) * length_m / bond_radius_m / 0.7;
  CHECK_THAT(steps_to_break(Vec3::Zero(), Vec3::UnitZ()),
             WithinAbs(angle_rad / step_m, tolerance_steps));
}

TEST_CASE("bond strength: compression alone never breaks", "[dem_core][bond]") {
  CHECK(steps_to_break(-Vec3::UnitZ(), Vec3::Zero()) == 100000);
}

TEST_CASE("bond strength: after breakage the contact stays", "[dem_core][bond]") {
  for (const bool beside : {true, false}) {
    Scene scene;
    scene.model.contact_beside_bond = beside;
    scene.law().bond = {.normal_scale = 5e3, .tensile_limit = 1, .cohesion_limit = 1};
    scene.sphere({0, 0, 0}, 1, fixed_mass_kg);
    scene.sphere({1.99, 0, 0}, 1, fixed_mass_kg);
    scene.model.bonds.push_back(bond_from_numbers(0, 1, 2.0));
    scene.plane({-1, 0, 0}, {2.985, 0, 0});
    scene.begin();
    CAPTURE(beside);
    // 0.01 m of overlap: contact 1e4 N/m, bond 5e3 N/m; the impulse of one step tells the force
    const auto push_N = [&] {
      const double before = scene.state.velocity_m_per_s(0).x();
      scene.run(1);
      return -(scene.state.velocity_m_per_s(0).x() - before) * fixed_mass_kg / scene.law().dt_s;
    };
    CHECK_THAT(push_N(), WithinAbs(beside ? 150 : 50, 1e-6));
    scene.state.bonds[7] = 0.0;
    CHECK_THAT(push_N(), WithinAbs(100, 1e-6));
  }
}
