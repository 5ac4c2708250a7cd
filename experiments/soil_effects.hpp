// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Candidate missing effects as numbers of a material: at the null values the baseline bit for bit.
// What they are called for people, their bounds and sources: data/effects.json; laws: docs/theory/effects.md.
#pragma once

#include "dem_core/model.hpp"
#include "experiments/field.hpp"

namespace tilth {

struct SoilEffects {
  // laws of bonds and contacts
  double bond_softening = 0.0;              ///< zeta
  double rate_strengthening = 0.0;          ///< C
  double capillary_cohesion_Pa = 0.0;       ///< bulk tensile strength of bridges alone (Rumpf)
  double tool_adhesion_Pa = 0.0;            ///< c_a on tools and on the plate of interface shear
  double contact_stiffness_exponent = 0.0;  ///< m
  double contact_plasticity = 0.0;          ///< lambda
  double crushing_compliance_per_Pa = 0.0;  ///< 1 / sigma_a
  double healed_strength_share = 0.0;       ///< h, of the bond tensile strength
  // strengths that differ from bond to bond
  double bond_strength_cv = 0.0;    ///< F
  double bond_anisotropy = 0.0;     ///< a
  double pan_strengthening = 0.0;   ///< kappa, below pan_depth_m
  double pan_depth_m = 0.05;        ///< under the surface of a bed; no effect of its own
  // offsets of what the baseline has
  double tensile_strength_shortfall = 0.0;      ///< share of the bond tensile strength
  double bond_friction_angle_offset_rad = 0.0;
  double tool_friction_offset = 0.0;
  double local_damping_change = 0.0;            ///< relative
  // how a test is set up (setup_effects.hpp)
  double porosity_offset = 0.0;
  double particle_size_change = 0.0;  ///< relative, of the grain diameter
  double loading_rate_change = 0.0;   ///< relative
  double domain_size_change = 0.0;    ///< relative, of every length of the specimen
  double tool_depth_offset_m = 0.0;
  double strength_drift = 0.0;        ///< relative, per day of testing
  // what the instruments make of it (measurement_effects.hpp)
  double seating_compliance_m_per_Pa = 0.0;
  double frame_load_gain = 0.0;
  double shear_box_load_gain = 0.0;
  double draught_load_gain = 0.0;
  double shear_box_friction_Pa = 0.0;
};

/// Names and ranges, in the order above.
std::vector<Field> fields(SoilEffects& effects);

/// Laws of a lane; rate and healing times stay at 1 until set_nominal_rate().
EffectLaw effect_law(const SoilEffects& effects, const BondMaterial& bond);

/// Bond material and friction with the offsets, kept inside their ranges.
BondMaterial with_offsets(BondMaterial bond, const SoilEffects& effects);

/// Tells rate-dependent laws how fast a test runs: `rate_per_s` is the virtual rate of strain that stands
/// for the standard rate of the laboratory, 2e-4 1/s. Virtual tests run faster than real ones on purpose, so
/// bonds know rates only over this one: strength rises above ten times it, bonds heal within 0.05 of strain.
void set_nominal_rate(Model& model, int lane, double rate_per_s);

inline constexpr double laboratory_rate_per_s = 2e-4;

}  // namespace tilth
