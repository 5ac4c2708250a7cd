// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The oedometer against isotropic elasticity, and its unload-reload loop.
#include <cmath>

#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

ExperimentResult compress(const SoilMaterial& soil, const ConfinedCompressionConfig& config) {
  const ExperimentResult r = run_confined_compression({&soil, 1}, config, packings()).front();
  INFO(r.message);
  REQUIRE(r.status == RunStatus::completed);
  return r;
}

/// Bonds and friction that nothing overcomes; stresses of 1/800 to 1/200 of the modulus.
SoilMaterial linear_soil() {
  SoilMaterial m = elastic_soil(20e6);
  m.friction = 10;
  m.contact_stiffness_ratio = m.bond.stiffness_ratio = 10;  // a Poisson ratio worth a test
  return m;
}

}  // namespace

TEST_CASE("Confined compression: an elastic specimen's moduli agree with isotropic elasticity",
          "[experiments][confined]") {
  ConfinedCompressionConfig ring = small_confined(3e-4);
  ring.num_particles = 400;
  const ExperimentResult confined = compress(linear_soil(), ring);
  UnconfinedCompressionConfig free{.specimen_radius_m = ring.ring_radius_m,
                                   .specimen_height_m = 2 * ring.ring_radius_m,
                                   .num_particles = 650,
                                   .platen_speed_over_wave_speed = 3e-4,
                                   .max_axial_strain = 5e-3};
  const SoilMaterial soil = linear_soil();
  const ExperimentResult unconfined =
      run_unconfined_compression({&soil, 1}, free, packings()).front();
  const double young_Pa = unconfined.feature("secant_modulus_Pa");
  const double constrained_Pa = confined.feature("constrained_modulus_Pa");
  const double k0 = confined.feature("radial_stress_ratio");
  const double nu = k0 / (1 + k0);
  REQUIRE(confined.curves.front().rows.back()[3] == 0);
  REQUIRE(constrained_Pa > young_Pa);
  REQUIRE_THAT(constrained_Pa,
               WithinRel(young_Pa * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), 0.1));
}

TEST_CASE("Confined compression: without breakage or slip it unloads as it loads",
          "[experiments][confined]") {
  const ExperimentResult r = compress(linear_soil(), small_confined(1e-4));
  const double loading_Pa = r.feature("constrained_modulus_Pa");
  REQUIRE_THAT(r.feature("unload_modulus_Pa"), WithinRel(loading_Pa, 0.02));
  REQUIRE_THAT(r.feature("reload_modulus_Pa"), WithinRel(loading_Pa, 0.02));
}

TEST_CASE("Confined compression: loose grains unload stiffer than they load",
          "[experiments][confined]") {
  ConfinedCompressionConfig config = small_confined(3e-4);
  config.bond_gap_over_radius = -1;
  const ExperimentResult r = compress(bonded_soil(), config);
  REQUIRE(r.feature("unload_modulus_Pa") > 1.1 * r.feature("constrained_modulus_Pa"));
  // Grains cannot pull at the ring, and carry a part of the load sideways.
  REQUIRE(r.feature("radial_stress_ratio") > 0);
  REQUIRE(r.feature("radial_stress_ratio") < 1);
}

TEST_CASE("Confined compression: k times stresses, moduli and strengths give the same strains",
          "[experiments][confined]") {
  ConfinedCompressionConfig config = small_confined();
  const ExperimentResult soft = compress(bonded_soil(1e6), config);
  config.load_from_stress_Pa *= 4;
  config.load_to_stress_Pa *= 4;
  config.unload_to_stress_Pa *= 4;
  const ExperimentResult stiff = compress(bonded_soil(4e6), config);
  // Rounding: 4 keeps the step on the ladder.
  REQUIRE_THAT(stiff.feature("compression_strain"),
               WithinRel(soft.feature("compression_strain"), 1e-9));
  REQUIRE_THAT(stiff.feature("constrained_modulus_Pa"),
               WithinRel(4 * soft.feature("constrained_modulus_Pa"), 1e-9));
  REQUIRE_THAT(stiff.feature("radial_stress_ratio"),
               WithinRel(soft.feature("radial_stress_ratio"), 1e-9));
}

TEST_CASE("Confined compression: the loop turns at its stresses", "[experiments][confined]") {
  const ExperimentResult r = compress(linear_soil(), small_confined(1e-4));
  double largest_Pa = 0, after_peak_Pa = 1e30;
  for (const auto& row : r.curves.front().rows) {
    if (row[1] > largest_Pa && after_peak_Pa > 50e3) largest_Pa = row[1];
    if (largest_Pa > 99e3) after_peak_Pa = std::min(after_peak_Pa, row[1]);
  }
  // Rows are 20 steps apart: the platens turn up to one interval late.
  REQUIRE_THAT(largest_Pa, WithinRel(100e3, 0.03));
  REQUIRE_THAT(after_peak_Pa, WithinRel(25e3, 0.12));
}

TEST_CASE("Confined compression: a second loop follows the first one's curve and adds its moduli",
          "[experiments][confined]") {
  ConfinedCompressionConfig config = small_confined(3e-4);
  config.bond_gap_over_radius = -1;
  const ExperimentResult one = compress(bonded_soil(), config);
  config.second_load_to_stress_Pa = 200e3;
  const ExperimentResult two = compress(bonded_soil(), config);
  for (const Feature& f : one.features) REQUIRE(two.feature(f.name) == f.value);
  const auto& rows = two.curves.front().rows;
  for (std::size_t n = 0; n < one.curves.front().rows.size(); ++n)
    REQUIRE(rows[n] == one.curves.front().rows[n]);
  // Loose grains stiffen with stress, and unload stiffer than they load.
  REQUIRE(two.feature("second_unload_modulus_Pa") > two.feature("unload_modulus_Pa"));
  REQUIRE(two.feature("second_reload_modulus_Pa") > two.feature("constrained_modulus_Pa"));
  REQUIRE(std::isnan(one.feature("second_unload_modulus_Pa")));
  // A linear specimen has one modulus in both loops.
  config = small_confined(1e-4);
  config.second_load_to_stress_Pa = 200e3;
  const ExperimentResult linear = compress(linear_soil(), config);
  REQUIRE_THAT(linear.feature("second_unload_modulus_Pa"),
               WithinRel(linear.feature("unload_modulus_Pa"), 0.02));
  REQUIRE_THAT(linear.feature("second_reload_modulus_Pa"),
               WithinRel(linear.feature("unload_modulus_Pa"), 0.02));
}

TEST_CASE("Confined compression: a rough ring takes its share of the load as Janssen has it",
          "[experiments][confined]") {
  // Both platens move, so the ring drags from either end to the middle: with sigma the axial and
  // K sigma the radial stress, d sigma / dz = -4 K mu sigma / D over half the height h / 2. The mean
  // radial stress over K times the stress at the platens is then
  //   (1 - exp(-x)) / x,   x = 4 K mu (h / 2) / D.
  ConfinedCompressionConfig ring{.ring_radius_m = 0.015,
                                 .ring_height_m = 0.06,
                                 .num_particles = 400,
                                 .platen_speed_over_wave_speed = 3e-4,
                                 .platen_friction_scale = 0};
  SoilMaterial soil = linear_soil();
  const double k0 = compress(soil, ring).feature("radial_stress_ratio");
  for (const double friction : {0.2, 0.5}) {
    soil.wall_friction = friction;
    const double ratio = compress(soil, ring).feature("radial_stress_ratio") / k0;
    const double x = 4 * k0 * friction * 0.5 * ring.ring_height_m / (2 * ring.ring_radius_m);
    CAPTURE(friction, k0, ratio, x);
    REQUIRE_THAT(ratio, WithinRel((1 - std::exp(-x)) / x, 0.05));
  }
}
