// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Direct tension against the closed forms of a chain of spheres, and against compression.
#include <cmath>
#include <numbers>

#include "experiments/curve_features.hpp"
#include "experiments/platens.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinRel;

namespace {

ExperimentResult pull(const SoilMaterial& soil, const DirectTensionConfig& config) {
  const ExperimentResult r = run_direct_tension({&soil, 1}, config, packings()).front();
  INFO(r.message);
  REQUIRE(r.status == RunStatus::completed);
  return r;
}

/// n touching spheres of radius 1 mm along z, from plate to plate.
Packing chain(int n) {
  Packing p;
  p.mean_radius_m = 1e-3;
  for (int i = 0; i < n; ++i) {
    p.radius_m.push_back(1e-3);
    p.position_m.emplace_back(0, 0, 1e-3 * (1 + 2 * i));
  }
  return p;
}

/// Strains a specimen between glued plates to 1e-5 and back to the reader: secant modulus there.
double small_strain_modulus_Pa(const SoilMaterial& soil, const DirectTensionConfig& c, double sense,
                               bool contact_beside_bond) {
  LaneRun run(make_specimen(*packings().get(packing_spec(c)), {&soil, 1},
                            platens(c.specimen_height_m),
                            {c.bond_gap_over_radius, {bottom_platen, top_platen}}));
  run.specimen.model.contact_beside_bond = contact_beside_bond;
  run.results[0].curves = {{"stress_strain", {"strain", "stress_Pa", "broken"}, {}}};
  run_past_peak(run,
                {.radius_m = c.specimen_radius_m,
                 .height_m = c.specimen_height_m,
                 .sense = sense,
                 .speed_m_per_s = {c.pull_speed_over_wave_speed * wave_speed_m_per_s(soil)},
                 .max_axial_strain = 2e-4},
                {});
  const Curve& curve = run.results[0].curves.front();
  REQUIRE(curve.rows.back()[2] == 0);
  return secant_at_share(curve, 0, 1, curve.rows.size() - 1, 0.8);
}

}  // namespace

TEST_CASE("Direct tension: a straight chain parts at sigma_c A and stretches as springs in series",
          "[experiments][tension]") {
  SoilMaterial soil = elastic_soil(2e6);
  soil.bond.tensile_strength_Pa = 10e3;
  for (const double lambda : {1.0, 0.6}) {
    soil.bond.radius_multiplier = lambda;
    const int n = 6;
    const double height_m = 2e-3 * n;
    LaneRun run(make_specimen(chain(n), {&soil, 1}, platens(height_m),
                              {0.1, {bottom_platen, top_platen}}));
    run.results[0].curves = {{"stress_strain", {"strain", "stress_Pa", "broken"}, {}}};
    // Stress over the area pi r^2 of a grain.
    run_past_peak(run,
                  {.radius_m = 1e-3,
                   .height_m = height_m,
                   .sense = -1,
                   .speed_m_per_s = {1e-6 * wave_speed_m_per_s(soil)},
                   .max_axial_strain = 0.02,
                   .stop_at_peak_share = 0.1},
                  {});
    const Curve& curve = run.results[0].curves.front();
    REQUIRE(run.results[0].message == "past the peak");
    REQUIRE(curve.rows.back()[2] >= 1);  // the parting may shake the equally loaded others apart
    const std::size_t peak = row_of_largest(curve, 1);
    // theory/bond.md (6) without moments: force sigma_c A with A = pi (lambda r)^2. 2e-3: rows are 20
    // steps apart and one interval's mean stands for its end.
    const double strength_Pa = 10e3 * lambda * lambda;
    REQUIRE_THAT(curve.rows[peak][1], WithinRel(strength_Pa, 2e-3));
    // n - 1 bonds of E_b A / (2 r), which alone pull (the contacts only push), and two glued contacts
    // of E_c pi r: strain / stress over the height. 2e-3 as above, and the chain's ringing.
    const double pi = std::numbers::pi;
    const double compliance_m_per_N = (n - 1) * 2e-3 / (2e6 * pi * 1e-6 * lambda * lambda) +
                                      2 / (2e6 * pi * 1e-3);
    const double modulus_Pa = height_m / (compliance_m_per_N * pi * 1e-6);
    REQUIRE_THAT(secant_at_share(curve, 0, 1, peak, 0.9), WithinRel(modulus_Pa, 5e-3));
  }
}

TEST_CASE("Direct tension: unbroken, a specimen whose bonds act alone pulls as it pushes",
          "[experiments][tension]") {
  const DirectTensionConfig config = small_tension(5e-5);
  const SoilMaterial soil = elastic_soil();
  const double push_Pa = small_strain_modulus_Pa(soil, config, 1, false);
  const double pull_Pa = small_strain_modulus_Pa(soil, config, -1, false);
  // 2e-3: at strains of 2e-4 the geometry differs by their order.
  REQUIRE_THAT(pull_Pa, WithinRel(push_Pa, 2e-3));
  // Contacts beside the bonds push and do not pull, so tension is softer, at most by the share
  // E_b / (E_c + E_b) = 1/2 that bonds have in a touching pair.
  const double beside_push_Pa = small_strain_modulus_Pa(soil, config, 1, true);
  const double beside_pull_Pa = small_strain_modulus_Pa(soil, config, -1, true);
  INFO("pull over push " << beside_pull_Pa / beside_push_Pa);
  REQUIRE(beside_pull_Pa < 0.98 * beside_push_Pa);
  REQUIRE(beside_pull_Pa > 0.5 * beside_push_Pa);
  REQUIRE(beside_push_Pa > push_Pa);
}

TEST_CASE("Direct tension: strengths and speed times k give k times the tensile strength",
          "[experiments][tension]") {
  // At small strain all laws are homogeneous of degree one: see the same test of compression.
  const auto pulled = [](double k) {
    SoilMaterial m = bonded_soil();
    m.bond.tensile_strength_Pa = m.bond.cohesion_Pa = k * 2.5e3;
    return pull(m, small_tension(k * 1e-4));
  };
  const ExperimentResult one = pulled(1);
  for (const double k : {0.5, 2.0}) {
    const ExperimentResult other = pulled(k);
    // 1e-2: strains of 1e-3 change the geometry, and rows stand apart.
    REQUIRE_THAT(other.feature("tensile_strength_Pa"),
                 WithinRel(k * one.feature("tensile_strength_Pa"), 1e-2));
    REQUIRE_THAT(other.feature("tensile_modulus_Pa"),
                 WithinRel(one.feature("tensile_modulus_Pa"), 1e-2));
  }
  // Moduli as well as strengths times 4: rounding only, the step stays on its ladder.
  SoilMaterial stiff = bonded_soil(8e6);
  const ExperimentResult a = pull(bonded_soil(2e6), small_tension());
  const ExperimentResult b = pull(stiff, small_tension());
  REQUIRE_THAT(b.feature("tensile_strength_Pa"),
               WithinRel(4 * a.feature("tensile_strength_Pa"), 1e-9));
}

TEST_CASE("Direct tension: bonded soil is weaker in tension than in compression, and loose grains "
          "carry none", "[experiments][tension]") {
  const SoilMaterial soil = bonded_soil();
  const ExperimentResult tension = pull(soil, small_tension());
  UnconfinedCompressionConfig press{.specimen_height_m = 0.05,
                                    .num_particles = 150,
                                    .platen_speed_over_wave_speed = 2e-4};
  const ExperimentResult compression =
      run_unconfined_compression({&soil, 1}, press, packings()).front();
  REQUIRE(tension.message == "past the peak");
  REQUIRE(tension.feature("tensile_strength_Pa") > 0);
  REQUIRE(tension.feature("tensile_strength_Pa") < compression.feature("peak_stress_Pa"));

  SoilMaterial loose = soil;
  loose.bond.tensile_strength_Pa = loose.bond.cohesion_Pa = 0;
  const ExperimentResult none =
      run_direct_tension({&loose, 1}, small_tension(1e-3), packings()).front();
  // Bonds without strength break in the first step that pulls; what is left is glue and inertia.
  REQUIRE((none.status == RunStatus::not_settled || none.feature("tensile_strength_Pa") <
                                                        0.1 * tension.feature("tensile_strength_Pa")));
}
