// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/contact_law.hpp"

#include <array>

#include "dem_core/rolling_kernel.hpp"

namespace tilth {
namespace {

using lanes::Pack;
using lanes::Pack3;

Pack3<1> pack(const Vec3& v) { return {{v.x()}, {v.y()}, {v.z()}}; }
Vec3 unpack(const Pack3<1>& v) { return {v.x.v, v.y.v, v.z.v}; }

using LawBlock = std::array<double, lanes::num_law_rows>;

LawBlock law_block(const ContactConstants& c) {
  LawBlock block{};
  block[lanes::law_shear_ratio] = c.shear_stiffness_ratio;
  block[lanes::law_inverse_shear_ratio] = 1 / c.shear_stiffness_ratio;
  block[lanes::law_friction] = c.friction;
  block[lanes::law_normal_damping] = c.normal_damping_N_s_per_m;
  block[lanes::law_tangential_damping] = c.tangential_damping_N_s_per_m;
  block[lanes::law_dt] = c.dt_s;
  return block;
}

LawBlock law_block(const BondLaw& law, double dt_s) {
  LawBlock block{};
  block[lanes::law_dt] = dt_s;
  block[lanes::law_bond_normal] = law.normal_scale;
  block[lanes::law_bond_shear] = law.shear_scale;
  block[lanes::law_bond_bending] = law.bending_scale;
  block[lanes::law_bond_twisting] = law.twisting_scale;
  block[lanes::law_tensile_limit] = law.tensile_limit;
  block[lanes::law_cohesion_limit] = law.cohesion_limit;
  block[lanes::law_tan_friction] = law.tan_friction;
  block[lanes::law_bending_in_tension] = law.bending_in_tension;
  block[lanes::law_twisting_in_shear] = law.twisting_in_shear;
  block[lanes::law_active] = 1.0;
  return block;
}

}  // namespace

ContactResponse contact_law(const ContactConstants& constants, const ContactMotion& motion,
                            const Vec3& spring_m) {
  const LawBlock block = law_block(constants);
  const lanes::Law<1> law(block.data());
  const lanes::Encounter<1> e{{0.0},
                              pack(motion.normal),
                              {motion.overlap_rate_m_per_s},
                              pack(motion.sliding_velocity_m_per_s)};
  std::array<double, 3> spring = {spring_m.x(), spring_m.y(), spring_m.z()};
  const lanes::ContactForce<1> f =
      lanes::contact_force<1>(law, law[lanes::law_friction], {motion.overlap_m > 0}, {constants.normal_stiffness_N_per_m * motion.overlap_m},
                              {constants.normal_stiffness_N_per_m}, {1.0}, e, spring.data());
  return {f.normal.v, unpack(f.tangential), Vec3(spring[0], spring[1], spring[2])};
}

RollingResponse rolling_law(const RollingConstants& constants, const RollingMotion& motion,
                            const Vec3& angle_rad) {
  LawBlock block{};
  block[lanes::law_rolling_friction] = constants.rolling_friction;
  block[lanes::law_dt] = constants.dt_s;
  const Pack3<1> a = pack(motion.spin_a_rad_per_s);
  const Pack3<1> b = pack(motion.spin_b_rad_per_s);
  std::array<double, 3> angle = {angle_rad.x(), angle_rad.y(), angle_rad.z()};
  const Pack3<1> moment = lanes::rolling_moment<1>(
      lanes::Law<1>(block.data()), {true},
      {{constants.rolling_radius_m}, {constants.shear_stiffness_N_per_m}, {motion.normal_N},
       pack(motion.normal), b - a, a + b},
      angle.data());
  return {unpack(moment), Vec3(angle[0], angle[1], angle[2])};
}

BondResponse bond_force_law(const BondLaw& constants, const BondGeometry& geometry, double dt_s,
                            const BondMotion& motion, const BondMemory& memory) {
  const LawBlock block = law_block(constants, dt_s);
  const lanes::Law<1> law(block.data());
  const lanes::Encounter<1> e{
      {motion.distance_m}, pack(motion.normal), {0.0}, pack(motion.sliding_velocity_m_per_s)};
  std::array<double, 8> bond = {memory.shear_N.x(),     memory.shear_N.y(),
                                memory.shear_N.z(),     memory.bending_N_m.x(),
                                memory.bending_N_m.y(), memory.bending_N_m.z(),
                                memory.twisting_N_m,    memory.holds ? 1.0 : 0.0};
  double num_broken = 0.0;
  const Pack3<1> a = pack(motion.spin_a_rad_per_s);
  const Pack3<1> b = pack(motion.spin_b_rad_per_s);
  const lanes::BondForce<1> f =
      lanes::bond_force<1>(law, geometry, e, b - a, a + b, bond.data(), &num_broken);
  return {.normal_N = f.normal.v,
          .shear_on_a_N = unpack(f.tangential),
          .moment_on_a_N_m = unpack(f.moment),
          .memory = {.shear_N = Vec3(bond[0], bond[1], bond[2]),
                     .bending_N_m = Vec3(bond[3], bond[4], bond[5]),
                     .twisting_N_m = bond[6],
                     .holds = bond[7] > 0.5}};
}

}  // namespace tilth
