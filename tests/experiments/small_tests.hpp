// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Small, fast virtual tests and soils to put into them.
#pragma once

#include <catch2/catch.hpp>

#include "experiments/cone_penetration.hpp"
#include "experiments/confined_compression.hpp"
#include "experiments/direct_shear.hpp"
#include "experiments/direct_tension.hpp"
#include "experiments/interface_shear.hpp"
#include "experiments/unconfined_compression.hpp"
#include "experiments/vane_shear.hpp"

namespace tilth::testing {

/// One store for all cases; it holds only what depends on the specification.
inline PackingStore& packings() {
  static PackingStore store;
  return store;
}

inline UnconfinedCompressionConfig small_unconfined(double speed = 1.6e-3) {
  return {.num_particles = 150, .platen_speed_over_wave_speed = speed};
}

inline ConfinedCompressionConfig small_confined(double speed = 1.6e-3) {
  return {.num_particles = 150, .platen_speed_over_wave_speed = speed};
}

inline DirectShearConfig small_shear(double speed = 1.6e-3) {
  return {.num_particles = 150, .shear_speed_over_wave_speed = speed, .max_shear_strain = 0.03};
}

inline DirectTensionConfig small_tension(double speed = 2e-4) {
  return {.num_particles = 150, .pull_speed_over_wave_speed = speed};
}

inline InterfaceShearConfig small_interface(double speed = 8e-4) {
  return {.num_particles = 150,
          .normal_stress_Pa = {10e3, 40e3},
          .slide_speed_over_wave_speed = speed,
          .max_slide_over_length = 0.02};
}

/// Coarse: for bits, not for numbers.
inline ConePenetrationConfig tiny_cone() {
  return {.num_particles = 150,
          .apex_angle_rad = 1.0,
          .base_diameter_m = 0.02,
          .depth_m = 0.01,
          .speed_m_per_s = 0.2};
}

inline VaneShearConfig tiny_vane() {
  return {.num_particles = 150, .tip_speed_over_wave_speed = 3e-3, .max_rotation_rad = 0.15};
}

/// A bonded soil whose bonds cannot break.
inline SoilMaterial elastic_soil(double modulus_Pa = 2e6) {
  SoilMaterial m;
  m.contact_modulus_Pa = m.bond.modulus_Pa = modulus_Pa;
  m.bond.tensile_strength_Pa = m.bond.cohesion_Pa = 1e12;
  return m;
}

/// A soil whose bonds break at 1/200 of their modulus.
inline SoilMaterial bonded_soil(double modulus_Pa = 2e6) {
  SoilMaterial m = elastic_soil(modulus_Pa);
  m.bond.tensile_strength_Pa = m.bond.cohesion_Pa = modulus_Pa / 200;
  return m;
}

/// Eight soils of unlike modulus, strength and friction; time steps and wave speeds differ too.
inline std::vector<SoilMaterial> eight_soils() {
  std::vector<SoilMaterial> soils;
  for (int k = 0; k < 8; ++k) {
    SoilMaterial m = bonded_soil(1e6 * (1 + k));
    m.bond.modulus_Pa = 1e6 * (1 + (3 * k) % 8);
    m.bond.tensile_strength_Pa = 5e3 * (1 + (3 * k) % 8);
    m.bond.cohesion_Pa = 5e3 * (1 + (5 * k) % 8);
    m.friction = 0.1 * (1 + (7 * k) % 8);
    soils.push_back(m);
  }
  return soils;
}

inline RunOptions with_lanes(int max_lanes) {
  RunOptions options;
  options.max_lanes = max_lanes;
  return options;
}

/// Status, time step, every curve and every feature, bit for bit.
inline void require_same(const ExperimentResult& a, const ExperimentResult& b) {
  REQUIRE(a.status == b.status);
  REQUIRE(a.dt_s == b.dt_s);
  REQUIRE(a.inertial_number == b.inertial_number);
  REQUIRE(a.curves.size() == b.curves.size());
  for (std::size_t c = 0; c < a.curves.size(); ++c) {
    REQUIRE(a.curves[c].name == b.curves[c].name);
    REQUIRE(a.curves[c].rows == b.curves[c].rows);
  }
  REQUIRE(a.features.size() == b.features.size());
  for (std::size_t f = 0; f < a.features.size(); ++f) {
    REQUIRE(a.features[f].name == b.features[f].name);
    REQUIRE(a.features[f].value == b.features[f].value);
  }
}

inline void require_same(const std::vector<ExperimentResult>& a,
                         const std::vector<ExperimentResult>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    INFO("member " << k);
    require_same(a[k], b[k]);
  }
}

inline std::size_t column_of(const Curve& curve, const std::string& name) {
  const auto found = std::find(curve.columns.begin(), curve.columns.end(), name);
  REQUIRE(found != curve.columns.end());
  return static_cast<std::size_t>(found - curve.columns.begin());
}

}  // namespace tilth::testing
