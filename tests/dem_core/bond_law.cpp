// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The bond law as a function of numbers; equations of docs/theory/bond.md.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "dem_core/contact_law.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double pi = std::numbers::pi;

BondMaterial soil_bond() {
  return {.modulus_Pa = 2e6,
          .stiffness_ratio = 2.5,
          .tensile_strength_Pa = 1e4,
          .cohesion_Pa = 2e4,
          .friction_angle_rad = 0.5,
          .radius_multiplier = 0.8,
          .moment_contribution = 0.6};
}

/// Cross-section of soil_bond() between grains of 5 mm and 4 mm.
struct Section {
  double radius_m = 0.8 * 4e-3;
  double length_m = 9e-3;
  double area_m2 = pi * radius_m * radius_m;
  double i_m4 = 0.25 * pi * std::pow(radius_m, 4);
  double j_m4 = 0.5 * pi * std::pow(radius_m, 4);
};

struct Dimer {
  BondLaw law = bond_law(soil_bond());
  BondGeometry geometry = parallel_bond(0, 1, 5e-3, 4e-3, 9e-3);
  BondResponse at(const BondMemory& memory, double stretch_m = 0) const {
    return bond_force_law(law, geometry, 1e-6, {.distance_m = 9e-3 + stretch_m}, memory);
  }
  bool survives(const BondMemory& memory, double tension_Pa = 0) const {
    return at(memory, tension_Pa * 9e-3 / 2e6).memory.holds;
  }
};

/// The criterion is met between 1 - 1e-12 and 1 + 1e-12 of the load: a few roundings.
constexpr double below = 1 - 1e-12;
constexpr double above = 1 + 1e-12;

}  // namespace

TEST_CASE("bond law: stiffness is that of a cylinder of elastic material", "[dem_core][bond]") {
  const Dimer d;
  const Section s;
  const double dt_s = 1e-6;
  // bond.md (1) to (4) with EA/L, GA/L, EI/L, GJ/L; 1e-13: products of five rounded numbers
  CHECK_THAT(d.at({}, -1e-6).normal_N, WithinRel(2e6 * s.area_m2 / s.length_m * 1e-6, 1e-9));
  const BondResponse slid = bond_force_law(
      d.law, d.geometry, dt_s, {.distance_m = 9e-3, .sliding_velocity_m_per_s = {1e-2, 0, 0}}, {});
  CHECK_THAT(slid.shear_on_a_N.x(), WithinRel(2e6 / 2.5 * s.area_m2 / s.length_m * 1e-8, 1e-13));
  const BondResponse bent = bond_force_law(
      d.law, d.geometry, dt_s, {.distance_m = 9e-3, .spin_b_rad_per_s = {0, 1e-2, 0}}, {});
  CHECK_THAT(bent.moment_on_a_N_m.y(), WithinRel(2e6 * s.i_m4 / s.length_m * 1e-8, 1e-13));
  const BondResponse twisted = bond_force_law(
      d.law, d.geometry, dt_s, {.distance_m = 9e-3, .spin_b_rad_per_s = {0, 0, 1e-2}}, {});
  CHECK_THAT(twisted.moment_on_a_N_m.z(), WithinRel(2e6 / 2.5 * s.j_m4 / s.length_m * 1e-8, 1e-13));
}

TEST_CASE("bond law: pulls when stretched, pushes when shortened", "[dem_core][bond]") {
  CHECK(Dimer().at({}, 1e-6).normal_N < 0);
  CHECK(Dimer().at({}, -1e-6).normal_N > 0);
}

TEST_CASE("bond law: breaks in tension at sigma_c", "[dem_core][bond]") {
  const Dimer d;
  CHECK(d.survives({}, 1e4 * (1 - 1e-9)));  // 1e-9: the stretch is a difference of lengths
  CHECK_FALSE(d.survives({}, 1e4 * (1 + 1e-9)));
  CHECK(d.survives({}, -1e6));
}

TEST_CASE("bond law: breaks in shear at the cohesion", "[dem_core][bond]") {
  const Dimer d;
  const double limit_N = 2e4 * Section().area_m2;
  CHECK(d.survives({.shear_N = {0, limit_N * below, 0}}));
  CHECK_FALSE(d.survives({.shear_N = {0, limit_N * above, 0}}));
}

TEST_CASE("bond law: compression raises the shear strength by tan(phi), tension lowers it",
          "[dem_core][bond]") {
  const Dimer d;
  for (const double pressure_Pa : {-5e3, 3e3, 1e5}) {
    const double limit_N = (2e4 + pressure_Pa * std::tan(0.5)) * Section().area_m2;
    CAPTURE(pressure_Pa);
    CHECK(d.survives({.shear_N = {limit_N * (1 - 1e-9), 0, 0}}, -pressure_Pa));
    CHECK_FALSE(d.survives({.shear_N = {limit_N * (1 + 1e-9), 0, 0}}, -pressure_Pa));
  }
}

TEST_CASE("bond law: bending adds beta |M| R / I to the tension", "[dem_core][bond]") {
  const Dimer d;
  const Section s;
  for (const double tension_Pa : {0.0, 4e3, -2e4}) {
    const double limit_N_m = (1e4 - tension_Pa) * s.i_m4 / s.radius_m / 0.6;
    CAPTURE(tension_Pa);
    CHECK(d.survives({.bending_N_m = {limit_N_m * (1 - 1e-9), 0, 0}}, tension_Pa));
    CHECK_FALSE(d.survives({.bending_N_m = {limit_N_m * (1 + 1e-9), 0, 0}}, tension_Pa));
  }
}

TEST_CASE("bond law: torsion adds beta |M| R / J to the shear, whatever its sense",
          "[dem_core][bond]") {
  const Dimer d;
  const Section s;
  const double limit_N_m = 2e4 * s.j_m4 / s.radius_m / 0.6;
  for (const double sense : {1.0, -1.0}) {
    CHECK(d.survives({.twisting_N_m = sense * limit_N_m * below}));
    CHECK_FALSE(d.survives({.twisting_N_m = sense * limit_N_m * above}));
    const double shear_N = 0.3 * 2e4 * s.area_m2;
    CHECK(
        d.survives({.shear_N = {shear_N, 0, 0}, .twisting_N_m = 0.7 * sense * limit_N_m * below}));
    CHECK_FALSE(
        d.survives({.shear_N = {shear_N, 0, 0}, .twisting_N_m = 0.7 * sense * limit_N_m * above}));
  }
}

TEST_CASE("bond law: a broken bond carries nothing and stays broken", "[dem_core][bond]") {
  const BondResponse r =
      Dimer().at({.shear_N = {1, 2, 3}, .bending_N_m = {1, 1, 1}, .holds = false}, -1e-5);
  CHECK_FALSE(r.memory.holds);
  CHECK(r.normal_N == 0.0);
  CHECK(r.shear_on_a_N.norm() == 0.0);
  CHECK(r.moment_on_a_N_m.norm() == 0.0);
  CHECK(r.memory.shear_N.norm() == 0.0);
}

TEST_CASE("bond law: stored vectors turn with the mean spin about the normal", "[dem_core][bond]") {
  const BondMotion m{
      .distance_m = 9e-3, .spin_a_rad_per_s = {0, 0, 10}, .spin_b_rad_per_s = {0, 0, 10}};
  const Dimer d;
  const BondResponse r = bond_force_law(d.law, d.geometry, 1e-4, m, {.shear_N = {1e-3, 0, 0}});
  // bond.md (5): x + w dt z cross x with w dt = 1e-3
  CHECK_THAT(r.shear_on_a_N.x(), WithinRel(1e-3, 1e-15));
  CHECK_THAT(r.shear_on_a_N.y(), WithinRel(1e-6, 1e-14));
}

TEST_CASE("bond material: every bad number is named", "[dem_core][bond]") {
  CHECK(problems(soil_bond()).empty());
  BondMaterial bad{.modulus_Pa = -1,
                   .stiffness_ratio = 0,
                   .tensile_strength_Pa = -1,
                   .cohesion_Pa = -1,
                   .friction_angle_rad = 2,
                   .radius_multiplier = 0,
                   .moment_contribution = 1.5};
  CHECK(problems(bad).size() == 7);
  bad = soil_bond();
  bad.tensile_strength_Pa = std::nan("");
  CHECK(problems(bad).size() == 1);
}
