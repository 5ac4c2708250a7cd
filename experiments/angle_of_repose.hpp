// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Angle of repose of loose grains behind a retaining wall that moves away.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct AngleOfReposeConfig {
  double column_length_m = 0.040;     ///< of the loose column, along the wall's motion
  double column_height_m = 0.060;
  double slab_thickness_m = 0.012;    ///< between two greased side walls
  double floor_over_column_length = 4.0;  ///< the wall moves at most that far from the back
  int num_particles = 1000;           ///< without those of the rough floor
  double porosity = 0.45;             ///< of the column before it settles
  double size_spread = 0.25;
  double gravity_m_per_s2 = 9.81;
  double stiffness_over_weight = 700;  ///< contact modulus over rho g column_height, for every member
  double restitution = 0.5;
  double local_damping = 0.0;         ///< instead of the member's: weight must not be braked
  double wall_speed_over_fall_speed = 0.3;  ///< over sqrt(g d), d the mean diameter
  double agitation_limit = 1e-5;      ///< at rest: kinetic energy per grain over m g r
  double angle_drift_limit_rad = 2e-3;  ///< at rest: change of the angle over 20 intervals
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(AngleOfReposeConfig& config);

/// One result per member.
///
/// A column of loose grains settles on a floor of fixed grains between greased walls; its front wall then
/// moves away at constant speed until it has left the heap or reached the floor's end; the heap comes to
/// rest. Friction between grains and rolling friction are the member's; bonds, contact modulus, wall
/// friction and local damping of the member are not used.
/// Curves `retreat`: time_s, wall_position_m, repose_angle_rad, agitation; `profile`: x_m, height_m.
/// Features: repose_angle_rad (line through the profile from 0.15 to 0.85 of the runout, falling away
/// from the back), heap_height_m (at the back), runout_m (see heap_profile.hpp).
/// A member that does not come to rest within 150 sqrt(height / g) of a stage, or whose heap is too short
/// for a line, is `not_settled`.
std::vector<ExperimentResult> run_angle_of_repose(std::span<const SoilMaterial> members,
                                                  const AngleOfReposeConfig& config,
                                                  PackingStore& packings,
                                                  const RunOptions& options = {});

}  // namespace tilth
