// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Model constants, their problems, and the stiffness and dashpots they become.
#include "dem_core/model.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

namespace {

constexpr double pi = std::numbers::pi;

/// Force on the second of two grains after one step, from the momentum it gains.
double push_N(Scene& scene, const Vec3& velocity_m_per_s = Vec3::Zero()) {
  scene.begin();
  scene.state.set_velocity_m_per_s(1, velocity_m_per_s);
  scene.run(1);
  return (scene.state.velocity_m_per_s(1) - velocity_m_per_s).x() * scene.model.mass_kg[1] /
         scene.law().dt_s;
}

Scene two_grains() {
  Scene scene;
  scene.sphere({0, 0, 0}, 1.0, 2.0);
  scene.sphere({1.49, 0, 0}, 0.5, 0.5);
  return scene;
}

}  // namespace

TEST_CASE("model: contact stiffness is E pi r_min^2 / (r_a + r_b), or the number itself",
          "[dem_core][model]") {
  Scene scene = two_grains();
  CHECK_THAT(push_N(scene), WithinRel(1e4 * 0.01, 1e-9));
  scene.model.stiffness_kind = StiffnessKind::modulus;
  CHECK_THAT(push_N(scene), WithinRel(1e4 * pi * 0.25 / 1.5 * 0.01, 1e-9));
}

TEST_CASE("model: the dashpot is number x sqrt(m k), or rate x m", "[dem_core][model]") {
  const double mass_kg = 2 * 0.5 / 2.5;
  Scene scene = two_grains();
  scene.law().normal_damping = 0.3;
  const Vec3 v(-0.1, 0, 0);
  CHECK_THAT(push_N(scene, v), WithinRel(100 + 0.3 * std::sqrt(mass_kg * 1e4) * 0.1, 1e-9));
  scene.model.damping_kind = DampingKind::rate;
  CHECK_THAT(push_N(scene, v), WithinRel(100 + 0.3 * mass_kg * 0.1, 1e-9));
}

TEST_CASE("model: an initial overlap with a reference distance carries no force",
          "[dem_core][model]") {
  Scene scene = two_grains();
  scene.model.references.push_back({0, 1, 1.49});
  CHECK(push_N(scene) == 0.0);
  scene.model.references[0].distance_m = 1.5 - 0.004;
  CHECK_THAT(push_N(scene), WithinRel(1e4 * 0.006, 1e-9));
}

TEST_CASE("model: unequal grains turn like gears about their contact point", "[dem_core][model]") {
  Scene scene = two_grains();
  scene.law().friction = 1;
  scene.law().dt_s = 1e-3;
  scene.begin();
  // arms (l + r_a - r_b) / 2 = 0.995 m and 0.495 m: without sliding, no tangential force
  scene.state.set_angular_velocity_rad_per_s(0, {0, 0, 0.495});
  scene.state.set_angular_velocity_rad_per_s(1, {0, 0, -0.995});
  scene.run(1);
  CHECK_THAT(scene.state.velocity_m_per_s(1).y(), WithinAbs(0, 1e-15));
  // turning the same way they slide by 2 x 0.995 x 0.495 m/s: F = k_s dt v
  scene.begin();
  scene.state.set_angular_velocity_rad_per_s(0, {0, 0, 0.495});
  scene.state.set_angular_velocity_rad_per_s(1, {0, 0, 0.995});
  scene.run(1);
  const double force_N = 5e3 * 1e-3 * 2 * 0.995 * 0.495;
  CHECK_THAT(scene.state.velocity_m_per_s(1).y() * 0.5 / 1e-3, WithinRel(force_N, 1e-9));
}

TEST_CASE("model: the damping number is 2 zeta of the oscillator that rebounds with e",
          "[dem_core][model]") {
  CHECK(damping_number(1.0) == 0.0);
  for (const double e : {0.1, 0.5, 0.9}) {
    const double zeta = 0.5 * damping_number(e);
    // contact.md (6)
    CHECK_THAT(std::exp(-zeta * pi / std::sqrt(1 - zeta * zeta)), WithinRel(e, 1e-14));
  }
}

TEST_CASE("model: masses are those of solid spheres", "[dem_core][model]") {
  CHECK_THAT(sphere_masses_kg({0.1}, 2650)[0], WithinRel(2650 * 4 / 3.0 * pi * 1e-3, 1e-14));
}

TEST_CASE("model: a sound model has no problems", "[dem_core][model]") {
  CHECK(problems(two_grains().model).empty());
}

TEST_CASE("model: every bad number is named", "[dem_core][model]") {
  const double nan = std::nan("");
  const auto complaint = [](auto spoil) {
    Scene scene = two_grains();
    scene.plane(Vec3::UnitZ(), {0, 0, -5});
    spoil(scene.model);
    const std::vector<std::string> found = problems(scene.model);
    return found.size() == 1 ? found[0] : std::to_string(found.size()) + " problems";
  };
  CHECK_THAT(complaint([&](Model& m) { m.lanes[0].contact_stiffness = nan; }),
             Contains("contact_stiffness"));
  CHECK_THAT(complaint([](Model& m) { m.lanes[0].shear_stiffness_ratio = 0; }),
             Contains("shear_stiffness_ratio"));
  CHECK_THAT(complaint([](Model& m) { m.lanes[0].friction = -0.1; }), Contains("friction"));
  CHECK_THAT(complaint([](Model& m) { m.lanes[0].wall_friction = -0.1; }),
             Contains("wall_friction"));
  CHECK_THAT(complaint([](Model& m) { m.lanes[0].normal_damping = -0.1; }),
             Contains("normal_damping"));
  CHECK_THAT(complaint([&](Model& m) { m.lanes[0].tangential_damping = nan; }),
             Contains("tangential_damping"));
  CHECK_THAT(complaint([](Model& m) { m.lanes[0].local_damping = 1; }), Contains("local_damping"));
  CHECK_THAT(complaint([](Model& m) { m.lanes[0].dt_s = 0; }), Contains("dt_s"));
  CHECK_THAT(complaint([&](Model& m) { m.lanes[0].bond.normal_scale = nan; }), Contains("bond"));
  CHECK_THAT(complaint([](Model& m) { m.lanes.resize(3, m.lanes[0]); }), Contains("num_lanes"));
  CHECK_THAT(complaint([](Model& m) { m.radius_m[0] = 0; }), Contains("radius_m"));
  CHECK_THAT(complaint([&](Model& m) { m.mass_kg[1] = nan; }), Contains("mass_kg"));
  CHECK_THAT(complaint([](Model& m) { m.mass_kg.pop_back(); }), Contains("masses"));
  CHECK_THAT(complaint([](Model& m) { m.bonds.push_back(bond_from_numbers(1, 0, 1)); }),
             Contains("bond (1, 0)"));
  CHECK_THAT(complaint([](Model& m) { m.bonds.push_back(bond_from_numbers(0, 2, 1)); }),
             Contains("bond (0, 2)"));
  CHECK_THAT(complaint([](Model& m) { m.bonds.assign(2, bond_from_numbers(0, 1, 1)); }),
             Contains("sorted"));
  CHECK_THAT(complaint([](Model& m) { m.walls[0].direction *= 2; }), Contains("wall 0"));
}

TEST_CASE("model: fixed grains carry others and keep their velocity", "[dem_core][model]") {
  // Two overlapping fixed grains that move together at 0.1 m/s carry a third in the notch between them.
  Scene scene;
  scene.sphere({-0.5, 0, 0});
  scene.sphere({0.5, 0, 0});
  scene.sphere({0, 0, 1.93});
  scene.model.gravity_m_per_s2 = {0, 0, -1};
  scene.law().normal_damping = 0.5;
  scene.model.num_fixed = 4;
  CHECK(problems(scene.model).size() == 1);
  scene.model.num_fixed = 2;
  scene.begin();
  for (int i = 0; i < 3; ++i) scene.state.set_velocity_m_per_s(i, {0.1, 0, 0});
  scene.run(20000);
  for (int i = 0; i < 2; ++i) {
    CHECK(scene.state.velocity_m_per_s(i) == Vec3(0.1, 0, 0));
    // 20 000 additions of dt v, 1e-16 each
    CHECK_THAT(scene.state.position_m(i).x(), WithinAbs(i - 0.5 + 0.2, 1e-11));
    CHECK(scene.state.position_m(i).z() == 0);
  }
  CHECK_THAT(scene.state.position_m(2).x(), WithinAbs(0.2, 1e-3));
  CHECK_THAT(scene.state.position_m(2).z(), WithinAbs(std::sqrt(3.75), 1e-2));  // what it fell and rocks
}
