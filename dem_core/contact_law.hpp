// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The contact law and the bond law of one lane as plain functions: testable with two numbers.
//
// Both run the kernels that step() runs, with one lane, so they return the same bits.
#pragma once

#include "dem_core/bond.hpp"
#include "dem_core/model.hpp"

namespace tilth {

/// Constants of one contact, already combined from LaneLaw and the two bodies.
struct ContactConstants {
  double normal_stiffness_N_per_m = 0.0;      ///< k_n > 0
  double shear_stiffness_ratio = 0.5;         ///< k_s / k_n > 0
  double friction = 0.0;                      ///< Coulomb coefficient >= 0
  double normal_damping_N_s_per_m = 0.0;      ///< c_n >= 0
  double tangential_damping_N_s_per_m = 0.0;  ///< c_t >= 0
  double dt_s = 0.0;                          ///< step over which the spring is lengthened
};

/// Geometry and relative motion of two bodies a and b.
struct ContactMotion {
  Vec3 normal = Vec3::UnitZ();                   ///< unit vector from a to b
  double overlap_m = 0.0;                        ///< positive while touching
  double overlap_rate_m_per_s = 0.0;             ///< positive while approaching
  Vec3 sliding_velocity_m_per_s = Vec3::Zero();  ///< of b against a, in the contact plane
};

struct ContactResponse {
  double normal_N = 0.0;                  ///< on b along the normal, positive pushes apart
  Vec3 tangential_on_a_N = Vec3::Zero();  ///< b receives the opposite
  Vec3 spring_m = Vec3::Zero();           ///< tangential displacement to carry into the next step
};

/// One step of a linear spring-dashpot contact with Coulomb slip and history.
///
///   F_n = k_n d + c_n ddot                                                     (contact.md, 1)
///   s*  = P (s + dt v_t),  P = 1 - n n^T                                       (contact.md, 2)
///   F_t = k_s s* + c_t v_t,                      k_s = ratio k_n               (contact.md, 3)
///   |F_t| > mu max(F_n, 0):  F_t <- mu max(F_n, 0) F_t / |F_t|,
///                            s <- (F_t - c_t v_t) / k_s                        (contact.md, 4)
///
/// F_n may turn attractive just before separation, so that the rebound is exactly the e of
/// damping_number(). Contact ends at d = 0, where the spring is emptied. The spring follows the
/// contact plane by projection; it does not turn with a spin about the normal. No adhesion.
///
/// @param spring_m  displacement of b against a stored by the previous step, 0 for a new contact
/// @return forces [N] and the new spring; all zero for d <= 0
/// @source Cundall & Strack, Geotechnique 29 (1979) 47-65; spring cut back at slip as in
///         Luding, Granular Matter 10 (2008) 235-246, section 2.2
ContactResponse contact_law(const ContactConstants& constants, const ContactMotion& motion,
                            const Vec3& spring_m);

/// Constants of the rolling spring of one contact, already combined from LaneLaw and the two bodies.
struct RollingConstants {
  double shear_stiffness_N_per_m = 0.0;  ///< k_s of the contact, > 0
  double rolling_radius_m = 0.0;  ///< Rbar = r_a r_b / (r_a + r_b); on a wall the grain's own, > 0
  double rolling_friction = 0.0;  ///< mu_r >= 0
  double dt_s = 0.0;              ///< step over which the spring is wound up
};

struct RollingMotion {
  Vec3 normal = Vec3::UnitZ();  ///< unit vector from a to b
  double normal_N = 0.0;        ///< F_n of the contact, positive pushes apart
  Vec3 spin_a_rad_per_s = Vec3::Zero();
  Vec3 spin_b_rad_per_s = Vec3::Zero();
};

struct RollingResponse {
  Vec3 moment_on_a_N_m = Vec3::Zero();  ///< b receives the opposite
  Vec3 angle_rad = Vec3::Zero();        ///< to carry into the next step
};

/// One step of the elastic-plastic rolling spring of an unbonded contact.
///
///   angle <- C angle + dt P (w_b - w_a),  P = 1 - n n^T, C as in bond.md, 5   (rolling.md, 1)
///   M = k_r angle on a,  k_r = k_s Rbar^2                                      (rolling.md, 2)
///   |M| > M_max = mu_r Rbar max(F_n, 0):  angle <- angle M_max / |M|, M anew   (rolling.md, 3)
///
/// Twist about the normal is not resisted, and there is no rolling dashpot. mu_r = 0 gives zero.
/// @source type C of Ai, Chen, Rotter & Ooi, Powder Technology 206 (2011) 269-282, without its
///         viscous part; k_r = k_s Rbar^2 as in PFC's rolling resistance linear model
RollingResponse rolling_law(const RollingConstants& constants, const RollingMotion& motion,
                            const Vec3& angle_rad);

/// Relative motion of two bonded bodies a and b.
struct BondMotion {
  Vec3 normal = Vec3::UnitZ();                   ///< unit vector from a to b
  double distance_m = 0.0;                       ///< between the centres
  Vec3 sliding_velocity_m_per_s = Vec3::Zero();  ///< of b against a, in the bond plane
  Vec3 spin_a_rad_per_s = Vec3::Zero();
  Vec3 spin_b_rad_per_s = Vec3::Zero();
};

/// What a bond remembers; all of it acts on a, b receives the opposite.
struct BondMemory {
  Vec3 shear_N = Vec3::Zero();
  Vec3 bending_N_m = Vec3::Zero();
  double twisting_N_m = 0.0;  ///< about the normal
  bool holds = true;
};

struct BondResponse {
  double normal_N = 0.0;  ///< on b along the normal, positive pushes apart
  Vec3 shear_on_a_N = Vec3::Zero();
  Vec3 moment_on_a_N_m = Vec3::Zero();  ///< bending and twisting
  BondMemory memory;
};

/// One step of a parallel bond; stiffness k and limits as in BondGeometry.
///
///   F_n = k_n (L_0 - l)                          total, not incremental        (bond.md, 1)
///   F_s <- C F_s + k_s dt v_t                                                  (bond.md, 2)
///   M_b <- C M_b + k_b dt P (w_b - w_a)                                        (bond.md, 3)
///   M_t <- M_t + k_t dt n . (w_b - w_a)                                        (bond.md, 4)
///   C v = P (v + dt/2 n . (w_a + w_b)  n x v),   P = 1 - n n^T                 (bond.md, 5)
///
/// The bond breaks, for good and within this step, where (T = -F_n > 0 in tension)
///   T/A + beta_b |M_b| R/I > sigma_c   or
///   |F_s|/A + beta_t |M_t| R/J > c_b - tan(phi_b) T/A.                         (bond.md, 6, 7)
/// C is first order in the step's rotation: a vector turned by an angle at rate w keeps its length
/// to w^2 t dt / 2.
///
/// @return forces [N] and moments [N m] of the unbroken bond; all zero once broken
/// @source Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41 (2004) 1329-1364, section 2.2
BondResponse bond_force_law(const BondLaw& law, const BondGeometry& geometry, double dt_s,
                            const BondMotion& motion, const BondMemory& memory);

}  // namespace tilth
