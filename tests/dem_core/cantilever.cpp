// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A row of bonded spheres as a beam: Timoshenko's closed forms and the chain's own discrete ones
// (docs/theory/bond.md, equations 8 to 11).
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "dem_core/time_step.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::fixed_mass_kg;
using tilth::testing::Scene;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double modulus_Pa = 1e4;
constexpr double stiffness_ratio = 2.5;
constexpr double spacing_m = 2.0;  // spheres of 1 m that just touch; bonds of 1 m radius

/// Spheres 0 to num_bonds along x, the first one clamped, and an anchor n + 1 that loads the last
/// through a bond of which only one stiffness is not zero.
struct Beam {
  Scene scene;
  int tip = 0;
  double start_tip_angle_rad = 0;

  Beam(int num_bonds, const Vec3& anchor_m, double strength_Pa = 1e30) : tip(num_bonds) {
    const BondMaterial material{.modulus_Pa = modulus_Pa,
                                .stiffness_ratio = stiffness_ratio,
                                .tensile_strength_Pa = strength_Pa,
                                .cohesion_Pa = strength_Pa};
    scene.model.contact_beside_bond = false;
    for (int i = 0; i <= num_bonds; ++i)
      scene.sphere({spacing_m * i, 0, 0}, 1, i == 0 ? fixed_mass_kg : 1.0);
    scene.sphere(scene.start_m.back() + anchor_m, 1, fixed_mass_kg);
    for (int i = 0; i < num_bonds; ++i)
      scene.model.bonds.push_back(parallel_bond(i, i + 1, 1, 1, spacing_m));
    BondGeometry& load = scene.bond(num_bonds, num_bonds + 1);
    load.normal_factor = load.shear_factor = load.bending_factor = load.twisting_factor = 0;
    load.inverse_area = load.bending_per_area = load.twisting_per_area = 0;
    scene.law().bond = bond_law(material);
    scene.law().local_damping = 0.7;
  }

  BondGeometry& load() { return scene.model.bonds.back(); }

  void begin() {
    scene.begin();
    scene.law().dt_s = 0.5 * stable_time_step_s(scene.model, scene.state);
  }

  /// 10 periods of the first bending mode: local damping then leaves less than 1e-6 of the load.
  int num_settling_steps() const {
    const double length_m = spacing_m * tip;
    const double period_s =
        2 * pi * length_m * length_m / 3.516 / std::sqrt(modulus_Pa * 0.25 * pi / (1 / spacing_m));
    return static_cast<int>(10 * period_s / scene.model.lanes[0].dt_s) + 2000;
  }

  /// Pull of the anchor's spring.
  double pull_N() const {
    const BondGeometry& g = scene.model.bonds.back();
    const double distance_m = (scene.state.position_m(g.j) - scene.state.position_m(g.i)).norm();
    return scene.model.lanes[0].bond.normal_scale * g.normal_factor *
           (distance_m - g.rest_length_m);
  }

  Vec3 tip_displacement_m() const {
    return scene.state.position_m(tip) - scene.start_m[static_cast<std::size_t>(tip)];
  }
};

/// The anchor is far away and its spring soft: an almost constant pull of `force_N`.
void pull_tip(Beam& beam, double force_N) {
  beam.load().normal_factor = force_N / 50 / modulus_Pa;  // the spring is stretched by 50 m
  beam.load().rest_length_m -= 50;
}

/// Deflection under a unit tip load with num_bonds spheres.
double bending_compliance_m_per_N(int num_bonds) {
  Beam beam(num_bonds, {0, 0, -1000});
  pull_tip(beam, 1e-6 * modulus_Pa);
  beam.begin();
  beam.scene.run(beam.num_settling_steps());
  return -beam.tip_displacement_m().z() / beam.pull_N();
}

/// A chain of n rigid spheres hinged at mid-gap: bond i carries F (n - i + 1/2) L and F.
double chain_compliance_m_per_N(int n) {
  const double k_s = modulus_Pa / stiffness_ratio * pi / spacing_m;
  const double k_b = modulus_Pa * 0.25 * pi / spacing_m;
  return spacing_m * spacing_m / k_b * (n * n * n / 3.0 - n / 12.0) + n / k_s;
}

/// Timoshenko beam of length n L with the bond's own shear stiffness (shear coefficient 1).
double timoshenko_compliance_m_per_N(int n) {
  const double length_m = n * spacing_m;
  return std::pow(length_m, 3) / (3 * modulus_Pa * 0.25 * pi) +
         length_m / (modulus_Pa / stiffness_ratio * pi);
}

}  // namespace

TEST_CASE("cantilever: the tip deflection is the chain's closed form", "[dem_core][bond]") {
  for (const int n : {1, 2, 4, 8}) {
    CAPTURE(n);
    // 1e-5: settled to 1e-6; the deflection of 1e-4 n^2 m changes lever arms in second order
    CHECK_THAT(bending_compliance_m_per_N(n), WithinRel(chain_compliance_m_per_N(n), 1e-5));
  }
}

TEST_CASE(
    "cantilever: the deflection converges to Timoshenko's beam with the square of the spacing",
    "[dem_core][bond]") {
  const auto error = [](int n) {
    return 1 - bending_compliance_m_per_N(n) / timoshenko_compliance_m_per_N(n);
  };
  const double coarse = error(4);
  const double fine = error(16);
  CAPTURE(coarse, fine);
  // bond.md (9): the bending part is short by 1 / (4 n^2), the shear part is exact
  CHECK_THAT(coarse, WithinRel(1.0 / 64, 0.05));  // 3 % of this deflection is shear
  CHECK_THAT(std::log2(coarse / fine) / 2, WithinAbs(2.0, 0.1));
}

TEST_CASE("cantilever: axial load stretches a row by F L / (E A)", "[dem_core][bond]") {
  Beam beam(8, {1000, 0, 0});
  pull_tip(beam, 1e-6 * modulus_Pa);
  beam.begin();
  beam.scene.run(20000);
  const double stretch_m = beam.pull_N() * 8 * spacing_m / (modulus_Pa * pi);
  CHECK_THAT(beam.tip_displacement_m().x(), WithinRel(stretch_m, 1e-8));
}

TEST_CASE("cantilever: a tip torque twists a row by T L / (G J)", "[dem_core][bond]") {
  Beam beam(8, {spacing_m, 0, 0});
  beam.load().twisting_factor = 0.1;
  beam.begin();
  Scene& s = beam.scene;
  s.state.set_angular_velocity_rad_per_s(beam.tip + 1, {1e-2, 0, 0});
  double twist_rad = 0;
  for (int n = 0; n < 40000; ++n) {
    if (n == 1000) s.state.set_angular_velocity_rad_per_s(beam.tip + 1, Vec3::Zero());
    twist_rad += s.law().dt_s * s.state.angular_velocity_rad_per_s(beam.tip).x();
    s.run(1);
  }
  // the loading bond acts on the tip with its stored twist moment
  const double torque_N_m = s.state.bonds[s.state.bonds.size() - 2];
  const double closed_form_rad =
      torque_N_m * 8 * spacing_m / (modulus_Pa / stiffness_ratio * 0.5 * pi);
  REQUIRE(torque_N_m > 0);
  CHECK_THAT(twist_rad, WithinRel(closed_form_rad, 1e-8));
}

TEST_CASE("cantilever: the root bond breaks first, where its bending stress reaches the strength",
          "[dem_core][bond]") {
  const double strength_Pa = 1e-4 * modulus_Pa;
  Beam beam(4, {0, 0, -1000}, strength_Pa);
  beam.load().normal_factor = 1e-6;
  beam.begin();
  Scene& s = beam.scene;
  // sigma = F (n - 1/2) L R / I of the root bond
  const double closed_form_N = strength_Pa * 0.25 * pi / (3.5 * spacing_m);
  // the load grows to its limit in 50 000 steps, some 60 periods of the beam
  const double stretch_m = closed_form_N / (1e-6 * modulus_Pa);
  s.state.set_velocity_m_per_s(beam.tip + 1, {0, 0, -stretch_m / (50000 * s.law().dt_s)});
  int n = 0;
  while (s.state.bond_holds(0) && n < 60000) {
    s.run(1);
    ++n;
  }
  CAPTURE(n);
  // 2e-3: what the moving load leaves of vibration
  CHECK_THAT(beam.pull_N(), WithinRel(closed_form_N, 2e-3));
  CHECK(num_bonds_held(s.model, s.state) == 4);  // three of the beam and the loading one
}
