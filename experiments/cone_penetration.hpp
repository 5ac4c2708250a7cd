// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A cone pushed into a bed of grains under gravity, bonded or not, and drawn back.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct ConePenetrationConfig {
  double chamber_radius_m = 0.040;
  double bed_height_m = 0.090;        ///< before it settles
  int num_particles = 2000;
  double porosity = 0.40;
  double size_spread = 0.25;
  double bond_gap_over_radius = 0.1;  ///< below 0 nothing is bonded
  double gravity_m_per_s2 = 9.81;
  double apex_angle_rad = 0.5235987755982988;  ///< full angle; 30 degrees
  double base_diameter_m = 0.01283;   ///< the small cone of the agricultural standard
  double shaft_diameter_m = 0.00953;
  int num_sides = 12;                 ///< of the mesh that stands for the cone
  double depth_m = 0.040;             ///< of the cone's base below the surface at the end
  double withdrawal_over_depth = 0.25;  ///< how far it is drawn back afterwards
  /// 30 mm/s in ASABE S313. Gravity, not the stiffness, sets the clock of a bed: what counts is
  /// v / sqrt(g d), and only the number of steps depends on the member's stiffness.
  double speed_m_per_s = 0.03;
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(ConePenetrationConfig& config);

/// The packing the test begins with.
PackingSpec packing_spec(const ConePenetrationConfig& config);

/// One result per member.
///
/// The packing, bonded where it touches, settles under gravity in a greased cylinder; then the cone
/// moves down its axis. Depth is that of the cone's base below the mean settled surface, as in ASABE
/// S313; force is positive against the motion downwards, resistance is force over base area.
/// Curves `penetration` and `withdrawal`: depth_m, cone_force_N, cone_resistance_Pa, bonds_broken.
/// Features: cone_resistance_Pa (mean over the lower half of the depth), cone_resistance_gradient_Pa_per_m
/// (least-squares slope from the surface down), pull_out_force_N (largest force holding the cone down
/// while it is drawn back, >= 0; in a bed without bonds it is friction on the shaft and the weight of
/// grains above the base).
std::vector<ExperimentResult> run_cone_penetration(std::span<const SoilMaterial> members,
                                                   const ConePenetrationConfig& config,
                                                   PackingStore& packings,
                                                   const RunOptions& options = {});

}  // namespace tilth
