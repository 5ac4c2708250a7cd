// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A bond's stored forces follow the bond through large rotations (docs/theory/bond.md, equation 5).
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "dem_core/contact_law.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

namespace {

constexpr double turn = 2 * std::numbers::pi;

struct Stored {
  Vec3 shear_N, bending_N_m;
};

/// One full turn of a bond about `axis` in num_steps, both grains turning with it.
Stored after_one_turn(const Vec3& axis, const Stored& start, int num_steps) {
  BondMemory memory{.shear_N = start.shear_N, .bending_N_m = start.bending_N_m};
  const BondLaw law{.normal_scale = 1,
                    .shear_scale = 1,
                    .bending_scale = 1,
                    .twisting_scale = 1,
                    .tensile_limit = 1e9,
                    .cohesion_limit = 1e9};
  const BondGeometry geometry = bond_from_numbers(0, 1, 1.0);
  const double dt_s = 1.0 / num_steps;
  for (int n = 1; n <= num_steps; ++n) {
    const Vec3 normal = Eigen::AngleAxisd(turn * n / num_steps, axis) * Vec3::UnitX();
    const BondMotion motion{.normal = normal,
                            .distance_m = 1,
                            .spin_a_rad_per_s = turn * axis,
                            .spin_b_rad_per_s = turn * axis};
    memory = bond_force_law(law, geometry, dt_s, motion, memory).memory;
  }
  return {memory.shear_N, memory.bending_N_m};
}

}  // namespace

TEST_CASE("bond rotation: after a full turn about any axis the stored vectors are back",
          "[dem_core][bond]") {
  const Stored start{{0, 3, 4}, {0, -2, 1}};
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(Vec3(1, 1, 1).normalized())}) {
    const auto error = [&](int num_steps) {
      const Stored end = after_one_turn(axis, start, num_steps);
      return std::max((end.shear_N - start.shear_N).norm() / 5,
                      (end.bending_N_m - start.bending_N_m).norm() / std::sqrt(5.0));
    };
    CAPTURE(axis.transpose(), error(1000), error(8000));
    // each step loses or gains the square of its angle: order 1, at most (2 pi)^2 / (2 n) per turn
    CHECK(error(1000) < 1.05 * turn * turn / 2000);
    CHECK_THAT(std::log2(error(1000) / error(8000)) / 3, WithinAbs(1.0, 0.05));
  }
}

TEST_CASE("bond rotation: a spinning dimer keeps its stored shear across the bond",
          "[dem_core][bond]") {
  // heavy grains: the stored force of 1 N does not move them within the turn
  const auto end_state = [](int num_steps) {
    Scene scene;
    const double mass_kg = 1e6;
    scene.sphere({-1, 0, 0}, 1, mass_kg);
    scene.sphere({1, 0, 0}, 1, mass_kg);
    scene.bond(0, 1);
    scene.model.contact_beside_bond = false;
    scene.law().bond = {
        .normal_scale = 1e11, .shear_scale = 1e-9, .tensile_limit = 1e30, .cohesion_limit = 1e30};
    scene.law().dt_s = 1.0 / num_steps;
    scene.begin();
    for (int i = 0; i < 2; ++i) {
      scene.state.set_velocity_m_per_s(i, {0, (i == 0 ? -1 : 1) * turn, 0});
      scene.state.set_angular_velocity_rad_per_s(i, {0, 0, turn});
    }
    scene.state.bonds[1] = 0.6;  // in the plane of rotation
    scene.state.bonds[2] = 0.8;  // along the axis of rotation
    scene.run(num_steps);
    const Vec3 bond = scene.state.position_m(1) - scene.state.position_m(0);
    const Vec3 shear(scene.state.bonds[0], scene.state.bonds[1], scene.state.bonds[2]);
    CHECK(std::abs(shear.dot(bond)) < 1e-2 * 2);
    return shear.norm();
  };
  const double coarse = 1 - end_state(4000);
  const double fine = 1 - end_state(16000);
  CAPTURE(coarse, fine);
  // only the part in the plane of rotation shortens: 0.36 (2 pi)^2 / (2 n) of the magnitude
  CHECK_THAT(coarse, WithinRel(0.36 * turn * turn / 8000, 0.02));
  CHECK_THAT(std::log2(coarse / fine) / 2, WithinAbs(1.0, 0.02));
}
