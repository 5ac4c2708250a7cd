// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Soil on steel: a block slides at exactly the steel's friction, loose grains roll below it.
#include <cmath>

#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

ExperimentResult slide(const SoilMaterial& soil, const InterfaceShearConfig& config) {
  const ExperimentResult r = run_interface_shear({&soil, 1}, config, packings()).front();
  INFO(r.message);
  REQUIRE(r.status == RunStatus::completed);
  return r;
}

SoilMaterial on_steel(SoilMaterial soil, double wall_friction) {
  soil.wall_friction = wall_friction;
  return soil;
}

}  // namespace

TEST_CASE("Interface shear: a bonded block slides at the friction of the steel",
          "[experiments][interface]") {
  InterfaceShearConfig config = small_interface(1e-4);
  for (const double friction : {0.1, 0.3}) {
    const ExperimentResult r = slide(on_steel(elastic_soil(), friction), config);
    // Every grain on the steel slips along x: Coulomb's ratio at every stress, no adhesion. 1e-3:
    // slips of single grains turn a little aside.
    REQUIRE_THAT(std::tan(r.feature("interface_friction_angle_rad")), WithinRel(friction, 1e-3));
    REQUIRE_THAT(r.feature("adhesion_Pa"), WithinAbs(0.0, 1e-3 * 40e3 * friction));
    REQUIRE_THAT(r.feature("residual_interface_stress_Pa@40000"),
                 WithinRel(friction * 40e3, 0.01));  // the servo's hold
  }
  const ExperimentResult greased = slide(on_steel(elastic_soil(), 0), config);
  REQUIRE(greased.feature("peak_interface_stress_Pa@40000") == 0);
}

TEST_CASE("Interface shear: only the steel is rough", "[experiments][interface]") {
  // Were the greased box rough, it would carry a part of the normal load or of the drag.
  const ExperimentResult r = slide(on_steel(elastic_soil(), 0.3), small_interface(1e-4));
  for (const Curve& curve : r.curves) {
    const std::size_t normal = column_of(curve, "normal_stress_Pa");
    const double target_Pa = curve.name == "slide_10000Pa" ? 10e3 : 40e3;
    // What the servo's top plate presses arrives at the steel: inertia and the servo's hold, 2 %.
    REQUIRE_THAT(curve.rows.back()[normal], WithinRel(target_Pa, 0.02));
  }
}

TEST_CASE("Interface shear: loose grains roll on the steel, below its friction",
          "[experiments][interface]") {
  InterfaceShearConfig config = small_interface(4e-4);
  config.bond_gap_over_radius = -1;
  config.max_slide_over_length = 0.1;
  SoilMaterial soil = bonded_soil();
  const ExperimentResult r = slide(on_steel(soil, 0.5), config);
  const double tan_angle = std::tan(r.feature("interface_friction_angle_rad"));
  INFO("tan(angle) " << tan_angle);
  // Coulomb's limit is an upper bound whatever rolls or slips; 1e-3 of rounding in the line.
  REQUIRE(r.feature("residual_interface_stress_Pa@40000") < 0.5 * 41e3);
  REQUIRE(tan_angle < 0.5);
  REQUIRE(tan_angle > 0.05);
}
