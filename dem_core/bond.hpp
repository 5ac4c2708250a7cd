// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Parallel bonds: per-bond geometry (shared by all lanes) times per-lane law constants.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tilth {

/// What one bond contributes whatever the lane: stiffness = BondLaw number x factor here.
///
///   k_n = normal_scale normal_factor       k_s = shear_scale shear_factor      [N/m]
///   k_b = bending_scale bending_factor     k_t = twisting_scale twisting_factor [N m per rad]
///   tension side:  T inverse_area + bending_in_tension |M_b| bending_per_area        > tensile_limit
///   shear side:    |F_s| inverse_area + twisting_in_shear |M_t| twisting_per_area
///                                        > cohesion_limit - tan_friction T inverse_area
/// with T > 0 in tension. Constants may be given as plain numbers (bond_from_numbers).
struct BondGeometry {
  std::int32_t i = 0;
  std::int32_t j = 0;
  double rest_length_m = 0.0;  ///< distance without normal force
  double normal_factor = 0.0;
  double shear_factor = 0.0;
  double bending_factor = 0.0;
  double twisting_factor = 0.0;
  double inverse_area = 0.0;
  double bending_per_area = 0.0;
  double twisting_per_area = 0.0;
};

/// Constants of the bonds of one lane; see BondGeometry for how they enter.
struct BondLaw {
  double normal_scale = 0.0;
  double shear_scale = 0.0;
  double bending_scale = 0.0;
  double twisting_scale = 0.0;
  double tensile_limit = 0.0;
  double cohesion_limit = 0.0;
  double tan_friction = 0.0;
  double bending_in_tension = 0.0;
  double twisting_in_shear = 0.0;
};

/// Material of a parallel bond, in the words of PFC.
struct BondMaterial {
  double modulus_Pa = 0.0;           ///< E_b: normal stiffness per area times bond length, >= 0
  double stiffness_ratio = 2.0;      ///< kappa_b = k_n / k_s per area, > 0
  double tensile_strength_Pa = 0.0;  ///< sigma_c, >= 0
  double cohesion_Pa = 0.0;          ///< c_b, >= 0
  double friction_angle_rad = 0.0;   ///< phi_b in [0, pi/2)
  double radius_multiplier = 1.0;    ///< lambda: bond radius over the smaller grain radius, > 0
  double moment_contribution = 1.0;  ///< beta: share of the moments in the stresses, in [0, 1]
};

/// Everything wrong with a bond material, one sentence each.
std::vector<std::string> problems(const BondMaterial& material);

/// Lane constants of a parallel bond. With lambda = 1 geometry in BondGeometry (R_1 = r_min):
///   normal E_b lambda^2, shear E_b/kappa lambda^2, bending E_b lambda^4, twisting E_b/kappa lambda^4,
///   tensile_limit sigma_c lambda^2, cohesion_limit c_b lambda^2, moments beta / lambda,
/// since A ~ lambda^2, I and J ~ lambda^4 and R/I ~ lambda^-3.
/// @source Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41 (2004) 1329-1364, section 2.2;
///         shear strength c + sigma tan(phi) as in PFC's linear parallel bond model
BondLaw bond_law(const BondMaterial& material);

/// Geometry of a parallel bond of radius min(r_i, r_j) and given rest length:
///   A = pi R^2, I = pi R^4/4, J = pi R^4/2; factors A/L, A/L, I/L, J/L with L = r_i + r_j;
///   inverse_area 1/A, bending_per_area R/I, twisting_per_area R/J.
BondGeometry parallel_bond(std::int32_t i, std::int32_t j, double radius_i_m, double radius_j_m,
                           double rest_length_m);

/// A bond whose constants are numbers: all factors 1, so that BondLaw holds k_n, k_s, k_b, k_t and
/// the force limits themselves; the moment numbers are the reciprocal moment limits times the
/// force limits. Rest length r_i + r_j or the distance at creation, as given.
BondGeometry bond_from_numbers(std::int32_t i, std::int32_t j, double rest_length_m);

}  // namespace tilth
