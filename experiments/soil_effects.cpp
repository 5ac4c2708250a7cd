// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/soil_effects.hpp"

#include <algorithm>

namespace tilth {

std::vector<Field> fields(SoilEffects& e) {
  return {{"bond_softening", &e.bond_softening, 0, 50},
          {"rate_strengthening", &e.rate_strengthening, 0, 1},
          {"capillary_cohesion_Pa", &e.capillary_cohesion_Pa, 0, 1e5},
          {"tool_adhesion_Pa", &e.tool_adhesion_Pa, 0, 1e5},
          {"contact_stiffness_exponent", &e.contact_stiffness_exponent, 0, 0.6},
          {"contact_plasticity", &e.contact_plasticity, 0, 0.95},
          {"crushing_compliance_per_Pa", &e.crushing_compliance_per_Pa, 0, 1e-3},
          {"healed_strength_share", &e.healed_strength_share, 0, 2},
          {"bond_strength_cv", &e.bond_strength_cv, 0, 1},
          {"bond_anisotropy", &e.bond_anisotropy, -0.6, 1},
          {"pan_strengthening", &e.pan_strengthening, 0, 20},
          {"pan_depth_m", &e.pan_depth_m, 0, 10},
          {"tensile_strength_shortfall", &e.tensile_strength_shortfall, 0, 1},
          {"bond_friction_angle_offset_rad", &e.bond_friction_angle_offset_rad, -1.5, 1.5},
          {"tool_friction_offset", &e.tool_friction_offset, -5, 5},
          {"local_damping_change", &e.local_damping_change, -0.9, 0.3},
          {"porosity_offset", &e.porosity_offset, -0.1, 0.1},
          {"particle_size_change", &e.particle_size_change, -0.6, 1},
          {"loading_rate_change", &e.loading_rate_change, -0.9, 9},
          {"domain_size_change", &e.domain_size_change, -0.5, 2},
          {"tool_depth_offset_m", &e.tool_depth_offset_m, -0.1, 0.1},
          {"strength_drift", &e.strength_drift, -0.3, 1},
          {"seating_compliance_m_per_Pa", &e.seating_compliance_m_per_Pa, 0, 1e-6},
          {"frame_load_gain", &e.frame_load_gain, -0.5, 1},
          {"shear_box_load_gain", &e.shear_box_load_gain, -0.5, 1},
          {"draught_load_gain", &e.draught_load_gain, -0.5, 1},
          {"shear_box_friction_Pa", &e.shear_box_friction_Pa, 0, 1e5}};
}

namespace {

/// Of the bulk, in Rumpf's relation; most packings here have 0.40.
constexpr double porosity = 0.40;

}  // namespace

EffectLaw effect_law(const SoilEffects& e, const BondMaterial& bond) {
  return {.bond_softening = e.bond_softening,
          .rate_strengthening = e.rate_strengthening,
          .capillary_Pa = e.capillary_cohesion_Pa * porosity / (1 - porosity),
          .tool_adhesion_Pa = e.tool_adhesion_Pa,
          .stiffness_exponent = e.contact_stiffness_exponent,
          .contact_plasticity = e.contact_plasticity,
          .crushing_compliance_per_Pa = e.crushing_compliance_per_Pa,
          .healing_Pa = e.healed_strength_share * bond.tensile_strength_Pa};
}

BondMaterial with_offsets(BondMaterial bond, const SoilEffects& e) {
  bond.tensile_strength_Pa *= 1 - e.tensile_strength_shortfall;
  bond.friction_angle_rad =
      std::clamp(bond.friction_angle_rad + e.bond_friction_angle_offset_rad, 0.0, 1.5);
  return bond;
}

void set_nominal_rate(Model& model, int lane, double rate_per_s) {
  EffectLaw& law = model.lanes[static_cast<std::size_t>(lane)].effects;
  law.rate_reference_per_s = 10 * rate_per_s;
  law.healing_time_s = 0.05 / rate_per_s;
}

}  // namespace tilth
