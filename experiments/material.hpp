// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The material of a virtual test: what calibration varies.
#pragma once

#include "dem_core/model.hpp"
#include "experiments/field.hpp"
#include "experiments/soil_effects.hpp"

namespace tilth {

/// Micro-parameters of bonded soil aggregates.
struct SoilMaterial {
  double contact_modulus_Pa = 2e6;      ///< E_c of the grain contact
  double contact_stiffness_ratio = 2;   ///< kappa = k_n / k_s of the contact
  double friction = 0.5;                ///< Coulomb coefficient between grains
  double wall_friction = 0.0;           ///< on platens and boxes: polished and greased
  double rolling_friction = 0.0;        ///< mu_r of unbonded contacts and walls; 0: round grains
  double tool_friction = 0.3;           ///< on cones and vanes: bare smooth steel (own choice)
  BondMaterial bond{.modulus_Pa = 2e6, .tensile_strength_Pa = 20e3, .cohesion_Pa = 20e3};
  double local_damping = 0.7;           ///< quasi-static tests; alpha of Cundall
  double density_kg_per_m3 = 2650;      ///< of one grain; scales out of tests without gravity
  SoilEffects effects = {};             ///< candidate missing effects: none
};

/// Names and ranges of all numbers of a material.
std::vector<Field> fields(SoilMaterial& material);

std::vector<std::string> problems(const SoilMaterial& material);

/// Laws of one lane; dt_s stays 0 until the time step is known.
LaneLaw lane_law(const SoilMaterial& material);

/// sqrt((E_c + E_b) / rho): the speed that platen speeds are measured against.
double wave_speed_m_per_s(const SoilMaterial& material);

}  // namespace tilth
