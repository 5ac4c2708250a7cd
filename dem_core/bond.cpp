// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/bond.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tilth {

std::vector<std::string> problems(const BondMaterial& m) {
  std::vector<std::string> found;
  const auto require = [&found](bool ok, const char* name, double value, const char* range) {
    if (!ok) found.push_back(fmt::format("{} = {}: must be {}", name, value, range));
  };
  require(std::isfinite(m.modulus_Pa) && m.modulus_Pa >= 0, "bond_modulus_Pa", m.modulus_Pa,
          "finite and >= 0");
  require(m.stiffness_ratio > 0, "bond_stiffness_ratio", m.stiffness_ratio, "> 0");
  require(m.tensile_strength_Pa >= 0, "bond_tensile_strength_Pa", m.tensile_strength_Pa, ">= 0");
  require(m.cohesion_Pa >= 0, "bond_cohesion_Pa", m.cohesion_Pa, ">= 0");
  require(m.friction_angle_rad >= 0 && m.friction_angle_rad < std::numbers::pi / 2,
          "bond_friction_angle_rad", m.friction_angle_rad, "in [0, pi/2)");
  require(m.radius_multiplier > 0, "bond_radius_multiplier", m.radius_multiplier, "> 0");
  require(m.moment_contribution >= 0 && m.moment_contribution <= 1, "moment_contribution",
          m.moment_contribution, "in [0, 1]");
  return found;
}

BondLaw bond_law(const BondMaterial& m) {
  const double area = m.radius_multiplier * m.radius_multiplier;
  const double second_moment = area * area;
  const double shear_modulus_Pa = m.modulus_Pa / m.stiffness_ratio;
  return {.normal_scale = m.modulus_Pa * area,
          .shear_scale = shear_modulus_Pa * area,
          .bending_scale = m.modulus_Pa * second_moment,
          .twisting_scale = shear_modulus_Pa * second_moment,
          .tensile_limit = m.tensile_strength_Pa * area,
          .cohesion_limit = m.cohesion_Pa * area,
          .tan_friction = std::tan(m.friction_angle_rad),
          .bending_in_tension = m.moment_contribution / m.radius_multiplier,
          .twisting_in_shear = m.moment_contribution / m.radius_multiplier};
}

BondGeometry parallel_bond(std::int32_t i, std::int32_t j, double radius_i_m, double radius_j_m,
                           double rest_length_m) {
  constexpr double pi = std::numbers::pi;
  const double radius_m = std::min(radius_i_m, radius_j_m);
  const double length_m = radius_i_m + radius_j_m;
  const double area_m2 = pi * radius_m * radius_m;
  const double second_moment_m4 = 0.25 * area_m2 * radius_m * radius_m;
  const double polar_moment_m4 = 2 * second_moment_m4;
  return {.i = i,
          .j = j,
          .rest_length_m = rest_length_m,
          .normal_factor = area_m2 / length_m,
          .shear_factor = area_m2 / length_m,
          .bending_factor = second_moment_m4 / length_m,
          .twisting_factor = polar_moment_m4 / length_m,
          .inverse_area = 1 / area_m2,
          .bending_per_area = radius_m / second_moment_m4,
          .twisting_per_area = radius_m / polar_moment_m4};
}

BondGeometry bond_from_numbers(std::int32_t i, std::int32_t j, double rest_length_m) {
  return {.i = i,
          .j = j,
          .rest_length_m = rest_length_m,
          .normal_factor = 1,
          .shear_factor = 1,
          .bending_factor = 1,
          .twisting_factor = 1,
          .inverse_area = 1,
          .bending_per_area = 1,
          .twisting_per_area = 1};
}

}  // namespace tilth
