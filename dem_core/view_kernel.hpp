// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Raw pointers into Model, State and Workspace for the kernels. Private to dem_core.
//
// The kernels are compiled once per instruction set; only plain pointers cross that border, so that
// no inline function of the standard library is ever emitted with instructions the processor lacks.
#pragma once

#include <cstdint>

namespace tilth {
struct PairRecord;
struct WallRecord;
struct BondGeometry;
struct MeshFeature;
struct HalfSpace;
}  // namespace tilth

namespace tilth::lanes {

/// Rows of the lane-constant block, each W doubles.
enum LawRow : int {
  law_contact_stiffness,
  law_shear_ratio,
  law_inverse_shear_ratio,
  law_friction,
  law_wall_friction,
  law_rolling_friction,
  law_tool_friction,
  law_normal_damping,
  law_tangential_damping,
  law_local_damping,
  law_dt,
  law_bond_normal,
  law_bond_shear,
  law_bond_bending,
  law_bond_twisting,
  law_tensile_limit,
  law_cohesion_limit,
  law_tan_friction,
  law_bending_in_tension,
  law_twisting_in_shear,
  law_bond_softening,
  law_rate_strengthening,
  law_rate_reference,
  law_capillary,
  law_healing,
  law_healing_time,
  law_tool_adhesion,
  law_stiffness_exponent,
  law_reference_pressure,
  law_contact_plasticity,
  law_crushing_compliance,
  law_active,
  num_law_rows
};

/// One wall as the kernel sees it.
struct WallView {
  bool cylinder;
  bool bounded;
  bool has_edges;
  double direction[3];
  double tangent_a[3];
  double tangent_b[3];
  double half_a_m;
  double half_b_m;
  double friction_scale;
  double adhesion_scale;
};

/// One tool as the kernel sees it.
struct ToolView {
  const MeshFeature* features;
  const HalfSpace* half_spaces;
  double max_depth_m;
};

/// A run of consecutive rows that one thread works on; see step_blocks.hpp.
struct BlockView {
  std::int64_t row_from, row_to;
  std::int64_t cross_from, cross_to;  ///< cross pairs whose i lies in the block
  const std::int32_t* cross_in;       ///< those whose j does, ascending
  std::int64_t num_cross_in;
  double* max_speed2;  ///< [W]
  double* num_broken;  ///< [W]
};

struct StepView {
  int num_particles;
  int num_walls;
  int num_bonds;
  bool contact_beside_bond;
  bool has_rolling;  ///< some lane has rolling friction; else the rolling springs are null
  bool has_effects;  ///< some lane has a law of effect_law.hpp; else the memories of effects are null
  const double* law;
  double* motion;
  double* force;
  const double* mass_kg;
  const double* inverse_mass_per_kg;
  const double* inverse_inertia_per_kg_m2;
  const double* radius_m;
  double gravity_m_per_s2[3];
  const std::int32_t* row_begin;
  const std::int32_t* row_end;   ///< of the pairs whose j lies in the block of i
  const std::int32_t* cross_pair;  ///< pairs whose j lies in a later block, ascending
  const std::int32_t* cross_row;   ///< their i
  double* cross_force;             ///< [cross pair][9][W]: force on j, turn of i, turn of j
  std::uint8_t* cross_acts;
  const PairRecord* pairs;
  std::uint8_t* touching;
  double* pair_spring_m;
  double* pair_rolling_rad;
  double* pair_effects;          ///< [pair][2][W]: plastic overlap, age of the contact
  const double* bond_strength;   ///< [bond][W], or null
  double* bond_worst;            ///< [bond][W]
  const BondGeometry* bond_geometry;
  double* bonds;
  const std::int32_t* wall_row_begin;
  const std::int32_t* wall_particle;
  const WallRecord* wall_pairs;
  double* wall_spring_m;
  double* wall_rolling_rad;
  const WallView* wall_views;
  const double* walls;          ///< [wall][4][W]
  const double* wall_velocity;  ///< [wall][4][W]: velocity (3), growth of the radius
  double* wall_force;           ///< [wall][6][W]
  int num_tools;
  const std::int32_t* tool_row_begin;
  const std::int32_t* tool_particle;
  const std::int32_t* tool_feature;
  const WallRecord* tool_pairs;
  double* tool_spring_m;
  const ToolView* tool_views;
  const double* tool_motion;  ///< [tool][18][W]: position, body axes, velocity, spin
  double* tool_load;          ///< [tool][7][W]: force, torque about the origin, touching contacts
  double* max_speed2;           ///< [W]
  double* num_broken;           ///< [W]
};

/// Forces of all pairs, bonds and walls, then one semi-implicit Euler step of every active lane.
template <int W>
void step_lanes(const StepView& view);

/// The same with the laws of effect_law.hpp; lanes at their null values get the bits of step_lanes().
template <int W>
void step_lanes_with_effects(const StepView& view);

/// The same step of several blocks, to the bit: cross_forces() for shares of the cross pairs, block_forces()
/// of every block, rigid_forces(), move_block() of every block. Calls of one kind may run side by side.
template <int W>
struct BlockStep {
  static void cross_forces(const StepView& view, const BlockView& block, std::int64_t from, std::int64_t to);
  static void block_forces(const StepView& view, const BlockView& block);
  static void rigid_forces(const StepView& view);
  static void move_block(const StepView& view, const BlockView& block);
};

/// BlockStep of step_lanes_with_effects().
template <int W>
struct BlockStepWithEffects {
  static void cross_forces(const StepView& view, const BlockView& block, std::int64_t from, std::int64_t to);
  static void block_forces(const StepView& view, const BlockView& block);
  static void rigid_forces(const StepView& view);
};

extern template void step_lanes<1>(const StepView&);
extern template void step_lanes_with_effects<1>(const StepView&);
extern template struct BlockStep<1>;
extern template struct BlockStepWithEffects<1>;
extern template void step_lanes<4>(const StepView&);
extern template void step_lanes_with_effects<4>(const StepView&);
extern template struct BlockStep<4>;
extern template struct BlockStepWithEffects<4>;
extern template void step_lanes<8>(const StepView&);
extern template void step_lanes_with_effects<8>(const StepView&);
extern template struct BlockStep<8>;
extern template struct BlockStepWithEffects<8>;

}  // namespace tilth::lanes
