// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Bonds that soften, know rates, and have strengths of their own: one bond, pulled and sheared.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

namespace {

constexpr double stiffness_N_per_m = 1e3;
constexpr double tensile_N = 10;
constexpr double cohesion_N = 20;
constexpr double elastic_m = tensile_N / stiffness_N_per_m;  ///< u_c

/// Two bonded grains a gap apart, so that only the bond acts; moved by hand.
struct Bonded {
  Scene scene;
  explicit Bonded(const EffectLaw& effects, double strength = 1.0) {
    scene.sphere({0, 0, 0});
    scene.sphere({2.5, 0, 0});
    scene.bond(0, 1);
    scene.law().bond = {.normal_scale = stiffness_N_per_m,
                        .shear_scale = stiffness_N_per_m,
                        .tensile_limit = tensile_N,
                        .cohesion_limit = cohesion_N};
    scene.law().effects = effects;
    if (strength != 1.0) scene.model.bond_strength = {strength};
    scene.begin();
  }
  /// Tension at this elongation, the ends at rest or drawn apart at a speed.
  double tension_N(double elongation_m, double speed_m_per_s = 0.0) {
    place(elongation_m, {speed_m_per_s, 0, 0});
    return (speed_m_per_s - scene.state.velocity_m_per_s(1).x()) / scene.law().dt_s;
  }
  /// Shear force after one step at this speed across.
  double shear_N(double speed_m_per_s, double elongation_m = 0.0) {
    place(elongation_m, {0, speed_m_per_s, 0});
    return (speed_m_per_s - scene.state.velocity_m_per_s(1).y()) / scene.law().dt_s;
  }
  bool holds() const { return scene.state.bond_holds(0); }

 private:
  void place(double elongation_m, const Vec3& velocity) {
    scene.state.set_position_m(0, Vec3::Zero());
    scene.state.set_position_m(1, {2.5 + elongation_m, 0, 0});
    scene.state.set_velocity_m_per_s(0, Vec3::Zero());
    scene.state.set_velocity_m_per_s(1, velocity);
    for (const int i : {0, 1}) scene.state.set_angular_velocity_rad_per_s(i, Vec3::Zero());
    scene.run(1);
  }
};

}  // namespace

TEST_CASE("Bond softening: the triangle of a pulled bond, its energy, and its end at (1 + zeta) u_c",
          "[dem_core][effects]") {
  for (const double zeta : {0.5, 3.0}) {
    Bonded bond({.bond_softening = zeta});
    const double end_m = (1 + zeta) * elastic_m;
    double work_J = 0.0, before_N = 0.0;
    const int n_max = 4000;
    for (int n = 1; n < n_max; ++n) {
      const double u_m = end_m * n / n_max;
      const double expected_N = u_m < elastic_m
                                    ? stiffness_N_per_m * u_m
                                    : tensile_N * (1 - (u_m - elastic_m) / (zeta * elastic_m));
      const double now_N = bond.tension_N(u_m);
      REQUIRE(bond.holds());
      REQUIRE_THAT(now_N, WithinAbs(expected_N, 1e-9 * tensile_N));
      work_J += 0.5 * (now_N + before_N) * end_m / n_max;
      before_N = now_N;
    }
    // one trapezoid spans the corner at the peak
    REQUIRE_THAT(work_J, WithinRel(0.5 * tensile_N * end_m, 1e-3));
    bond.tension_N(1.0001 * end_m);
    REQUIRE(!bond.holds());
  }
}

TEST_CASE("Bond softening: unloads towards zero, remembers, and pushes with its full stiffness",
          "[dem_core][effects]") {
  Bonded bond({.bond_softening = 3});
  const double most_N = bond.tension_N(2.5 * elastic_m);
  REQUIRE_THAT(most_N, WithinRel(0.5 * tensile_N, 1e-9));
  REQUIRE_THAT(bond.tension_N(1.25 * elastic_m), WithinRel(0.5 * most_N, 1e-9));
  REQUIRE_THAT(bond.tension_N(2.5 * elastic_m), WithinRel(most_N, 1e-9));
  REQUIRE_THAT(bond.tension_N(-elastic_m), WithinRel(-tensile_N, 1e-9));
  REQUIRE(bond.tension_N(2.6 * elastic_m) < most_N);
}

TEST_CASE("Bond softening: shear follows the same triangle", "[dem_core][effects]") {
  Bonded bond({.bond_softening = 2});
  const double per_step_N = 0.05;
  const double speed = per_step_N / (stiffness_N_per_m * bond.scene.law().dt_s);
  double peak_N = 0.0, at_double_N = 0.0;
  int steps = 0;
  for (; bond.holds() && steps < 5000; ++steps) {
    const double now_N = bond.shear_N(speed);
    peak_N = std::max(peak_N, now_N);
    if (steps + 1 == 800) at_double_N = now_N;  // elastic 40 N: twice the limit
  }
  REQUIRE_THAT(peak_N, WithinRel(cohesion_N, 1e-2));           // within one step
  REQUIRE_THAT(at_double_N, WithinRel(0.5 * cohesion_N, 1e-6));
  REQUIRE(std::abs(steps * per_step_N - 3 * cohesion_N) < 2 * per_step_N);
}

TEST_CASE("Rate-dependent strength: a bond pulled at a rate breaks at 1 + C ln(1 + rate / reference)",
          "[dem_core][effects]") {
  const double reference_per_s = 0.2;
  for (const double rate_over_reference : {0.0, 1.0, 99.0}) {
    const double speed = rate_over_reference * reference_per_s * 2.5;
    const double limit_N = tensile_N * (1 + 0.1 * std::log1p(rate_over_reference));
    Bonded bond({.rate_strengthening = 0.1, .rate_reference_per_s = reference_per_s});
    bond.tension_N(0.999 * limit_N / stiffness_N_per_m, speed);
    REQUIRE(bond.holds());
    bond.tension_N(1.001 * limit_N / stiffness_N_per_m, speed);
    REQUIRE(!bond.holds());
  }
}

TEST_CASE("Bond strengths: a factor on tension and on cohesion", "[dem_core][effects]") {
  Bonded bond({}, 1.5);
  bond.tension_N(1.49 * elastic_m);
  REQUIRE(bond.holds());
  bond.tension_N(1.51 * elastic_m);
  REQUIRE(!bond.holds());
  Bonded sheared({}, 0.5);
  const double speed = 0.1 / (stiffness_N_per_m * sheared.scene.law().dt_s);
  int steps = 0;
  for (; sheared.holds() && steps < 5000; ++steps) sheared.shear_N(speed);
  REQUIRE(std::abs(steps * 0.1 - 0.5 * cohesion_N) < 0.2);
}
