// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What unconfined compression must obey whatever the packing: dimensional analysis and the curve.
#include <cmath>

#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

ExperimentResult compress(const SoilMaterial& soil, const UnconfinedCompressionConfig& config) {
  const ExperimentResult r = run_unconfined_compression({&soil, 1}, config, packings()).front();
  REQUIRE(r.status == RunStatus::completed);
  return r;
}

/// Every modulus and every strength times k.
SoilMaterial scaled(SoilMaterial m, double k) {
  m.contact_modulus_Pa *= k;
  m.bond.modulus_Pa *= k;
  m.bond.tensile_strength_Pa *= k;
  m.bond.cohesion_Pa *= k;
  return m;
}

/// Rows of a: strain, stress, broken bonds; those of b have the same strain and k times the stress.
void require_scaled_curve(const ExperimentResult& a, const ExperimentResult& b, double k,
                          double tolerance) {
  const auto& rows_a = a.curves.front().rows;
  const auto& rows_b = b.curves.front().rows;
  REQUIRE(rows_a.size() == rows_b.size());
  for (std::size_t n = 0; n < rows_a.size(); ++n) {
    REQUIRE_THAT(rows_b[n][0], WithinRel(rows_a[n][0], tolerance));
    REQUIRE_THAT(rows_b[n][1], WithinRel(k * rows_a[n][1], tolerance));
    REQUIRE(rows_b[n][2] == rows_a[n][2]);
  }
}

}  // namespace

TEST_CASE("Unconfined compression: stress goes exactly with the moduli at equal speed ratio",
          "[experiments][unconfined]") {
  UnconfinedCompressionConfig config = small_unconfined(8e-4);
  config.max_axial_strain = 0.01;
  const ExperimentResult soft = compress(elastic_soil(2e6), config);
  REQUIRE(soft.curves.front().rows.back()[2] == 0);
  // 4 and 1/16 keep the ratio of the time steps (2, 1/4) on the ladder, so only rounding differs.
  for (const double k : {4.0, 1.0 / 16}) {
    SoilMaterial other = elastic_soil(2e6 * k);
    const ExperimentResult stiff = compress(other, config);
    require_scaled_curve(soft, stiff, k, 1e-9);
    REQUIRE_THAT(stiff.feature("secant_modulus_Pa"),
                 WithinRel(k * soft.feature("secant_modulus_Pa"), 1e-9));
  }
  // Off the ladder the step is another share of the stable bound: 5e-3 for the time integration
  // and the sampling of the curve.
  REQUIRE_THAT(compress(elastic_soil(6e6), config).feature("secant_modulus_Pa"),
               WithinRel(3 * soft.feature("secant_modulus_Pa"), 5e-3));
}

TEST_CASE("Unconfined compression: moduli and strengths times k give k times the broken curve",
          "[experiments][unconfined]") {
  const ExperimentResult soft = compress(bonded_soil(1e6), small_unconfined());
  const ExperimentResult stiff = compress(scaled(bonded_soil(1e6), 4), small_unconfined());
  REQUIRE(soft.curves.front().rows.back()[2] > 0);
  require_scaled_curve(soft, stiff, 4, 1e-9);
  REQUIRE_THAT(stiff.feature("peak_stress_Pa"),
               WithinRel(4 * soft.feature("peak_stress_Pa"), 1e-9));
  REQUIRE(stiff.feature("bonds_broken_at_peak") == soft.feature("bonds_broken_at_peak"));
}

TEST_CASE("Unconfined compression: density scales out", "[experiments][unconfined]") {
  // 16 times the density: a quarter of the wave speed, four times the step, the same quotients.
  SoilMaterial heavy = bonded_soil();
  heavy.density_kg_per_m3 *= 16;
  require_scaled_curve(compress(bonded_soil(), small_unconfined()),
                       compress(heavy, small_unconfined()), 1, 1e-9);
}

TEST_CASE("Unconfined compression: specimens of different size but like shape have the same curve",
          "[experiments][unconfined]") {
  const auto sized = [](double k) {
    UnconfinedCompressionConfig c = small_unconfined();
    c.specimen_radius_m *= k;
    c.specimen_height_m *= k;
    return compress(bonded_soil(), c);
  };
  const ExperimentResult small = sized(1);
  // 16 keeps the step on its place on the ladder: rounding only.
  require_scaled_curve(small, sized(16), 1, 1e-6);
  // 10 changes the step's share of the bound by up to a quarter.
  const ExperimentResult large = sized(10);
  REQUIRE_THAT(large.feature("secant_modulus_Pa"),
               WithinRel(small.feature("secant_modulus_Pa"), 1e-2));
  REQUIRE_THAT(large.feature("peak_stress_Pa"), WithinRel(small.feature("peak_stress_Pa"), 2e-2));
}

TEST_CASE("Unconfined compression: the peak goes with the bond strength",
          "[experiments][unconfined]") {
  // At small strain all laws are homogeneous of degree one: strength and speed times k at the same
  // moduli give k times every displacement and force.
  const auto peak_Pa = [](double k) {
    SoilMaterial m = bonded_soil();
    m.bond.tensile_strength_Pa = m.bond.cohesion_Pa = k * 2.5e3;
    return compress(m, small_unconfined(k * 2e-4)).feature("peak_stress_Pa");
  };
  const double weak_Pa = peak_Pa(1);
  // 3e-2: strains of 1 % at the peak, and rows apart by a few per cent of it (1e-2 seen).
  for (const double k : {0.5, 2.0, 4.0})
    REQUIRE_THAT(peak_Pa(k), WithinRel(k * weak_Pa, 0.03));
}

TEST_CASE("Unconfined compression: it stops past the peak, or at the strain limit",
          "[experiments][unconfined]") {
  UnconfinedCompressionConfig config = small_unconfined();
  const ExperimentResult past = compress(bonded_soil(), config);
  const auto& rows = past.curves.front().rows;
  REQUIRE(past.message == "past the peak");
  REQUIRE(rows.back()[1] < 0.7 * past.feature("peak_stress_Pa"));
  REQUIRE(rows.back()[0] > 1.15 * past.feature("strain_at_peak"));
  for (std::size_t n = 1; n < rows.size(); ++n) {
    REQUIRE(rows[n][0] > rows[n - 1][0]);
    REQUIRE(rows[n][2] >= rows[n - 1][2]);
  }
  // A small first drop is no end: the strain must be past the peak's too.
  config.stop_at_peak_share = 0.99;
  const ExperimentResult hasty = compress(bonded_soil(), config);
  REQUIRE(hasty.curves.front().rows.back()[0] > 1.15 * hasty.feature("strain_at_peak"));
  config.max_axial_strain = 0.5 * past.feature("strain_at_peak");
  const ExperimentResult early = compress(bonded_soil(), config);
  REQUIRE(early.message == "at the strain limit");
  // One interval of 20 steps is the resolution.
  const double interval = rows[1][0] - rows[0][0];
  REQUIRE_THAT(early.curves.front().rows.back()[0],
               WithinAbs(config.max_axial_strain + 0.5 * interval, 0.5 * interval + 1e-12));
}

TEST_CASE("Unconfined compression: a second rate adds the ratio of the peaks and moves nothing else",
          "[experiments][unconfined]") {
  UnconfinedCompressionConfig config = small_unconfined(2e-4);
  const ExperimentResult slow = compress(bonded_soil(), config);
  config.fast_rate_ratio = 8;
  const ExperimentResult both = compress(bonded_soil(), config);
  UnconfinedCompressionConfig fast_alone = small_unconfined(8 * 2e-4);
  const ExperimentResult fast = compress(bonded_soil(), fast_alone);
  for (const Feature& f : slow.features) REQUIRE(both.feature(f.name) == f.value);
  REQUIRE(both.curves[0].rows == slow.curves[0].rows);
  REQUIRE(both.curves[1].rows == fast.curves[0].rows);
  REQUIRE(both.curves[1].name == "stress_strain_fast");
  REQUIRE(both.inertial_number == slow.inertial_number);
  REQUIRE(both.feature("fast_peak_ratio") ==
          fast.feature("peak_stress_Pa") / slow.feature("peak_stress_Pa"));
  REQUIRE(std::isnan(slow.feature("fast_peak_ratio")));
  // Inertia is the baseline's only rate effect: it shows at 16e-4 and is gone at slow platens.
  REQUIRE(both.feature("fast_peak_ratio") > 1.2);
  config = small_unconfined(2.5e-5);
  config.fast_rate_ratio = 2;
  // 5e-2: the peak of a brittle specimen is within 2 % of its limit at 5e-5
  // (docs/experiments/unconfined_compression.md); another order of breaking adds its scatter.
  REQUIRE_THAT(compress(bonded_soil(), config).feature("fast_peak_ratio"), WithinAbs(1.0, 0.05));
}
