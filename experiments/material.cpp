// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/material.hpp"

#include <algorithm>
#include <cmath>

namespace tilth {

std::vector<Field> fields(SoilMaterial& m) {
  std::vector<Field> all = {
          {"contact_modulus_Pa", &m.contact_modulus_Pa, 1e2, 1e12},
          {"stiffness_ratio", &m.contact_stiffness_ratio, 0.1, 100},
          {"friction", &m.friction, 0, 10},
          {"wall_friction", &m.wall_friction, 0, 10},
          {"rolling_friction", &m.rolling_friction, 0, 2},
          {"tool_friction", &m.tool_friction, 0, 10},
          {"bond_modulus_Pa", &m.bond.modulus_Pa, 0, 1e12},
          {"bond_stiffness_ratio", &m.bond.stiffness_ratio, 0.1, 100},
          {"bond_tensile_strength_Pa", &m.bond.tensile_strength_Pa, 0, 1e12},
          {"bond_cohesion_Pa", &m.bond.cohesion_Pa, 0, 1e12},
          {"bond_friction_angle_rad", &m.bond.friction_angle_rad, 0, 1.5},
          {"bond_radius_multiplier", &m.bond.radius_multiplier, 0.05, 2},
          {"moment_contribution", &m.bond.moment_contribution, 0, 1},
          {"local_damping", &m.local_damping, 0, 0.95},
          {"grain_density_kg_per_m3", &m.density_kg_per_m3, 10, 20000}};
  for (const Field& f : fields(m.effects)) all.push_back(f);
  return all;
}

std::vector<std::string> problems(const SoilMaterial& material) {
  SoilMaterial copy = material;
  return range_problems(fields(copy));
}

LaneLaw lane_law(const SoilMaterial& m) {
  return {.contact_stiffness = m.contact_modulus_Pa,
          .shear_stiffness_ratio = 1 / m.contact_stiffness_ratio,
          .friction = m.friction,
          .wall_friction = m.wall_friction,
          .rolling_friction = m.rolling_friction,
          .tool_friction = std::max(m.tool_friction + m.effects.tool_friction_offset, 0.0),
          .local_damping =
              std::clamp(m.local_damping * (1 + m.effects.local_damping_change), 0.0, 0.95),
          .bond = bond_law(with_offsets(m.bond, m.effects)),
          .effects = effect_law(m.effects, m.bond)};
}

double wave_speed_m_per_s(const SoilMaterial& m) {
  return std::sqrt((m.contact_modulus_Pa + m.bond.modulus_Pa) / m.density_kg_per_m3);
}

}  // namespace tilth
