// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Candidate missing effects in virtual tests: strengths of bonds, setups, measurements, signs, null values.
#include <algorithm>
#include <cmath>

#include "experiments/bond_strengths.hpp"
#include "experiments/drained_triaxial.hpp"
#include "experiments/measurement_effects.hpp"
#include "experiments/setup_effects.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t k = 0; k < a.size(); ++k) ma += a[k] / n, mb += b[k] / n;
  for (std::size_t k = 0; k < a.size(); ++k) {
    aa += (a[k] - ma) * (a[k] - ma);
    bb += (b[k] - mb) * (b[k] - mb);
    ab += (a[k] - ma) * (b[k] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

Packing two_grains(const Vec3& branch) {
  Packing p;
  p.radius_m = {1.0, 1.0};
  p.position_m = {Vec3::Zero(), branch};
  p.mean_radius_m = 1.0;
  return p;
}

double strength_of_bond(const Packing& packing, const SoilEffects& effects, const BondPlace& place = {}) {
  SoilMaterial m = bonded_soil();
  m.effects = effects;
  Model model;
  model.bonds = {parallel_bond(0, 1, 1.0, 1.0, 2.0)};
  const AlignedDoubles s = bond_strengths(model, packing, {&m, 1}, place);
  return s.empty() ? 1.0 : s.front();
}

ExperimentResult with_effects(const SoilEffects& effects, const auto& run) {
  SoilMaterial m = bonded_soil();
  m.effects = effects;
  return run(std::vector{m}).front();
}

}  // namespace

TEST_CASE("Bond heterogeneity: the quantile has mean 1 and the asked-for scatter", "[experiments][effects]") {
  for (const double cv : {0.05, 0.3, 0.8}) {
    double mean = 0, square = 0;
    const int n = 5000;
    for (int k = 0; k < n; ++k) {
      const double w = weibull_quantile((k + 0.5) / n, cv);
      mean += w / n;
      square += w * w / n;
    }
    // midpoint rule: the tail beyond the last point is worth some 1e-4 of the mean
    REQUIRE_THAT(mean, WithinRel(1.0, 5e-4));
    REQUIRE_THAT(std::sqrt(square - mean * mean) / mean, WithinRel(cv, 2e-3));
  }
}

TEST_CASE("Bond heterogeneity: strength is continuous in F down to F = 0", "[experiments][effects]") {
  for (const double u : {1e-6, 0.3, 0.7, 1 - 1e-6}) {
    REQUIRE(weibull_quantile(u, 0.0) == 1.0);
    // 1 + F (sqrt(6) / pi) (ln(-ln(1 - u)) + gamma): Gumbel's limit
    const double slope = 0.7796968012336761 * (std::log(-std::log1p(-u)) + 0.5772156649015329);
    for (const double cv : {1e-3, 1e-5})
      REQUIRE_THAT(weibull_quantile(u, cv) - 1, WithinRel(slope * cv, 20 * cv * std::abs(slope) + 1e-3));
    REQUIRE(std::abs(weibull_quantile(u, 1e-9) - 1) < 1e-7);
  }
}

TEST_CASE("Bond heterogeneity: a bond's place is its own, and the packing's", "[experiments][effects]") {
  std::vector<double> a, next, other;
  for (int i = 0; i < 4000; ++i) {
    a.push_back(bond_uniform(17, i, i + 1));
    next.push_back(bond_uniform(17, i + 1, i + 2));
    other.push_back(bond_uniform(18, i, i + 1));
  }
  // five standard errors of 1 / sqrt(4000)
  REQUIRE(std::abs(correlation(a, next)) < 0.08);
  REQUIRE(std::abs(correlation(a, other)) < 0.08);
  double mean = 0;
  for (const double u : a) mean += u / 4000;
  REQUIRE_THAT(mean, WithinAbs(0.5, 0.025));
  REQUIRE(*std::ranges::min_element(a) > 0);
  REQUIRE(*std::ranges::max_element(a) < 1);
  Packing p = two_grains(Vec3::UnitX());
  const std::uint64_t number = packing_number(p);
  p.radius_m[1] = std::nextafter(1.0, 2.0);
  REQUIRE(packing_number(p) != number);
}

TEST_CASE("Anisotropic strength: a > 0 makes bonds across the layers stronger", "[experiments][effects]") {
  const SoilEffects layered{.bond_anisotropy = 0.4};
  REQUIRE_THAT(strength_of_bond(two_grains({0, 0, 2}), layered), WithinRel(1.4, 1e-12));
  REQUIRE_THAT(strength_of_bond(two_grains({2, 0, 0}), layered), WithinRel(0.8, 1e-12));
  REQUIRE_THAT(strength_of_bond(two_grains({2, 0, 0}), layered, {.bedding = Vec3::UnitX()}),
               WithinRel(1.4, 1e-12));
}

TEST_CASE("Depth-dependent strength: only bonds below the pan's depth, and only in a bed",
          "[experiments][effects]") {
  const SoilEffects pan{.pan_strengthening = 1.2, .pan_depth_m = 0.5};
  const Packing bond = two_grains({2, 0, 0});  // at z = 0
  REQUIRE_THAT(strength_of_bond(bond, pan, {.surface_m = 0.6}), WithinRel(2.2, 1e-12));
  REQUIRE(strength_of_bond(bond, pan, {.surface_m = 0.4}) == 1.0);
  REQUIRE(strength_of_bond(bond, pan) == 1.0);
}

TEST_CASE("Effects: the laws of a lane carry the material's numbers", "[experiments][effects]") {
  SoilMaterial m = bonded_soil();
  REQUIRE(!acts(lane_law(m).effects));
  m.effects = {.tensile_strength_shortfall = 0.25, .bond_friction_angle_offset_rad = 0.1,
               .tool_friction_offset = -1, .local_damping_change = -0.5};
  const LaneLaw law = lane_law(m);
  REQUIRE_THAT(law.bond.tensile_limit, WithinRel(0.75 * m.bond.tensile_strength_Pa, 1e-12));
  REQUIRE_THAT(law.bond.tan_friction, WithinRel(std::tan(m.bond.friction_angle_rad + 0.1), 1e-12));
  REQUIRE(law.tool_friction == 0);
  REQUIRE_THAT(law.local_damping, WithinRel(0.5 * m.local_damping, 1e-12));
  // Rumpf: sigma = F_0 (1 - n) / (n d^2)
  m.effects = {.capillary_cohesion_Pa = 900};
  REQUIRE_THAT(lane_law(m).effects.capillary_Pa * 0.6 / 0.4, WithinRel(900.0, 1e-12));
}

TEST_CASE("Setup effects: grain size, density, rate and size of the specimen are what is asked for",
          "[experiments][effects]") {
  UnconfinedCompressionConfig c;
  const double solid = (1 - c.porosity) / c.num_particles;
  apply_setup_effects("unconfined_compression", fields(c), {.porosity_offset = -0.02});
  REQUIRE_THAT(c.porosity, WithinRel(0.38, 1e-12));
  REQUIRE_THAT((1 - c.porosity) / c.num_particles, WithinRel(solid, 1e-3));  // N is whole
  c = {};
  apply_setup_effects("unconfined_compression", fields(c), {.particle_size_change = -0.3});
  REQUIRE_THAT(static_cast<double>(c.num_particles), WithinRel(1500 / 0.343, 1e-3));
  c = {};
  apply_setup_effects("unconfined_compression", fields(c), {.loading_rate_change = -0.5});
  REQUIRE(c.platen_speed_over_wave_speed == 1e-4);
  c = {};
  apply_setup_effects("unconfined_compression", fields(c), {.domain_size_change = 0.3});
  REQUIRE_THAT(c.specimen_height_m, WithinRel(0.13, 1e-12));
  REQUIRE_THAT(static_cast<double>(c.num_particles), WithinRel(1500 * 2.197, 1e-3));
  const SoilMaterial m = [] { SoilMaterial s = bonded_soil(); s.effects.strength_drift = 0.1; return s; }();
  REQUIRE(on_day_of_test("unconfined_compression", m).bond.cohesion_Pa == m.bond.cohesion_Pa);
  REQUIRE_THAT(on_day_of_test("direct_shear", m).bond.cohesion_Pa, WithinRel(1.1 * m.bond.cohesion_Pa, 1e-12));
}

TEST_CASE("Seating compliance: features are those of the curve it bends", "[experiments][effects]") {
  ConfinedCompressionConfig c = small_confined();
  const auto run = [&c](std::span<const SoilMaterial> m) {
    return run_confined_compression(m, c, packings());
  };
  const ExperimentResult plain = with_effects({}, run);
  ExperimentResult soft = plain;
  const double compliance = 2e-9;
  apply_measurement_effects("confined_compression", fields(c), {.seating_compliance_m_per_Pa = compliance}, soft);
  const auto& before = plain.curves.front().rows;
  const auto& after = soft.curves.front().rows;
  for (std::size_t k = 0; k < before.size(); ++k)
    REQUIRE_THAT(after[k][0] - before[k][0], WithinAbs(compliance * before[k][1] / c.ring_height_m, 1e-15));
  for (const char* name : {"constrained_modulus_Pa", "unload_modulus_Pa", "reload_modulus_Pa"})
    REQUIRE_THAT(1 / soft.feature(name), WithinRel(1 / plain.feature(name) + compliance / c.ring_height_m, 1e-12));
  REQUIRE(soft.feature("compression_strain") > plain.feature("compression_strain"));
  REQUIRE(soft.feature("radial_stress_ratio") == plain.feature("radial_stress_ratio"));
}

TEST_CASE("Load cells and shear boxes: gain and friction reach curves and features of their own rig alone",
          "[experiments][effects]") {
  ExperimentResult shear;
  shear.status = RunStatus::completed;
  shear.curves = {{"shear_10000Pa", {"shear_displacement_m", "shear_stress_Pa", "normal_stress_Pa"}, {{1, 5e3, 1e4}}}};
  shear.features = {{"peak_shear_stress_Pa@10000", 5e3}, {"cohesion_Pa", 2e3}, {"friction_angle_rad", 0.5},
                    {"displacement_at_peak_m", 1.0}};
  const std::vector<Field> none;
  ExperimentResult r = shear;
  apply_measurement_effects("direct_shear", none, {.shear_box_load_gain = 0.1}, r);
  REQUIRE_THAT(r.feature("peak_shear_stress_Pa@10000"), WithinRel(5.5e3, 1e-12));
  REQUIRE_THAT(std::tan(r.feature("friction_angle_rad")), WithinRel(1.1 * std::tan(0.5), 1e-12));
  REQUIRE(r.feature("displacement_at_peak_m") == 1.0);
  REQUIRE_THAT(r.curves[0].rows[0][1], WithinRel(5.5e3, 1e-12));
  REQUIRE(r.curves[0].rows[0][2] == 1e4);
  r = shear;
  apply_measurement_effects("direct_shear", none, {.shear_box_friction_Pa = 300}, r);
  REQUIRE(r.feature("cohesion_Pa") == 2.3e3);
  REQUIRE(r.feature("peak_shear_stress_Pa@10000") == 5.3e3);
  REQUIRE(r.feature("friction_angle_rad") == 0.5);
  r = shear;
  apply_measurement_effects("direct_shear", none, {.frame_load_gain = 0.1, .draught_load_gain = 0.2}, r);
  require_same(r, shear);
}

TEST_CASE("Density preparation leaves rolling resistance and cohesion out until the density is reached",
          "[experiments][effects]") {
  const DrainedTriaxialConfig c{.num_particles = 100,
                                .cell_pressure_Pa = {20e3},
                                .relative_density = {0.3},
                                .inertial_number = 4e-3,
                                .max_axial_strain = 0.06};
  SoilMaterial plain = bonded_soil();
  SoilMaterial rough = plain;
  rough.rolling_friction = 0.4;
  rough.effects.capillary_cohesion_Pa = 2e3;
  const auto results = run_drained_triaxial(std::vector{plain, rough}, c, packings());
  for (const ExperimentResult& r : results) REQUIRE(r.status == RunStatus::completed);
  const auto value = [&](int k, const std::string& name) {
    return results[static_cast<std::size_t>(k)].feature(name + "@20000,0.300");
  };
  REQUIRE(value(1, "loosest_void_ratio") == value(0, "loosest_void_ratio"));
  // What is left is the press at the end, with bridges and rolling on.
  REQUIRE_THAT(value(1, "initial_void_ratio"), WithinAbs(value(0, "initial_void_ratio"), 0.01));
  REQUIRE(value(1, "peak_stress_ratio") > 1.05 * value(0, "peak_stress_ratio"));
}

TEST_CASE("Interface shear: its intercept rises by the adhesion, whatever the size of the grains",
          "[experiments][effects][slow]") {
  for (const int n : {300, 1000}) {
    InterfaceShearConfig c = small_interface(4e-4);
    c.num_particles = n;
    SoilMaterial plain = elastic_soil();  // it shall slide on the steel, not shear within
    plain.wall_friction = 0.3;
    SoilMaterial sticky = plain;
    sticky.effects.tool_adhesion_Pa = 4e3;
    const auto r = run_interface_shear(std::vector{plain, sticky}, c, packings());
    for (const double p : c.normal_stress_Pa) {
      const std::string name = "residual_interface_stress_Pa@" + std::to_string(static_cast<int>(p));
      const double gained = r[1].feature(name) - r[0].feature(name);
      CAPTURE(n, p, gained);
      CHECK(gained > 0.9 * 4e3);
      CHECK(gained < 1.1 * 4e3);
    }
  }
}

TEST_CASE("Effects: the sign of every law in the test it is known by", "[experiments][effects]") {
  const auto ucs = [](std::span<const SoilMaterial> m) {
    UnconfinedCompressionConfig c = small_unconfined(4e-4);
    c.fast_rate_ratio = 30;
    c.max_axial_strain = 0.06;
    return run_unconfined_compression(m, c, packings());
  };
  const auto oedometer = [](std::span<const SoilMaterial> m) {
    return run_confined_compression(m, small_confined(), packings());
  };
  const auto tension = [](std::span<const SoilMaterial> m) {
    return run_direct_tension(m, small_tension(), packings());
  };
  const auto gain = [](const auto& test, const SoilEffects& effects, const char* feature) {
    return with_effects(effects, test).feature(feature) / with_effects({}, test).feature(feature);
  };
  CHECK(gain(ucs, {.bond_softening = 2}, "peak_stress_Pa") > 1.03);
  CHECK(gain(ucs, {.bond_softening = 2}, "strain_at_peak") > 1.03);
  CHECK(gain(tension, {.bond_softening = 2}, "tensile_strength_Pa") > 1.03);
  CHECK(gain(ucs, {.rate_strengthening = 0.1}, "fast_peak_ratio") > 1.03);
  CHECK_THAT(gain(ucs, {.rate_strengthening = 0.1}, "peak_stress_Pa"), WithinAbs(1.0, 0.05));
  CHECK(gain(tension, {.bond_strength_cv = 0.5}, "tensile_strength_Pa") < 0.97);
  CHECK(gain(tension, {.bond_anisotropy = 0.4}, "tensile_strength_Pa") > 1.03);
  CHECK(gain(ucs, {.contact_stiffness_exponent = 1.0 / 3}, "secant_modulus_Pa") < 0.97);
  CHECK(gain(oedometer, {.contact_plasticity = 0.8}, "unload_modulus_Pa") > 1.1);
  CHECK_THAT(gain(oedometer, {.contact_plasticity = 0.8}, "constrained_modulus_Pa"), WithinAbs(1.0, 0.05));
  CHECK(gain(oedometer, {.crushing_compliance_per_Pa = 1e-5}, "constrained_modulus_Pa") < 0.97);
  CHECK(gain(tension, {.tensile_strength_shortfall = 0.3}, "tensile_strength_Pa") < 0.9);
}
