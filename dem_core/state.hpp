// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a run changes: exactly what a restart needs (State), and what can be thrown away (Workspace).
//
// Lanes are the innermost index everywhere: entry [k][lane] of a block of packs stands at k * W + lane.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "dem_core/aligned.hpp"
#include "dem_core/mesh_features.hpp"
#include "dem_core/model.hpp"
#include "dem_core/records.hpp"

namespace tilth {

/// How one lane moves one wall.
struct WallDrive {
  Vec3 velocity_m_per_s = Vec3::Zero();  ///< used when servo_gain is 0
  double radial_velocity_m_per_s = 0.0;  ///< cylinders: growth of the radius
  /// > 0: the plane moves along its normal so that the compressive force of the specimen on it stays
  /// at the target: speed = gain e + integral, d(integral)/dt = integral_gain e, e = target - force,
  /// both clipped to max_speed. The integral is kept in velocity_m_per_s; without it a specimen that
  /// dilates steadily would hold the force off its target by (rate of dilation) / gain.
  double servo_gain_m_per_N_s = 0.0;
  double servo_integral_gain_m_per_N_s2 = 0.0;
  double target_force_N = 0.0;
  double max_speed_m_per_s = 0.0;
};

/// How one lane moves one tool: its origin translates, its body turns about that origin. Both are
/// constant in the world's directions until changed.
struct ToolDrive {
  Vec3 velocity_m_per_s = Vec3::Zero();
  Vec3 angular_velocity_rad_per_s = Vec3::Zero();
};

/// Contact memory in CSR form: row i holds partners j > i in ascending order.
struct ContactMemory {
  std::vector<std::int32_t> row_begin;  ///< num_particles + 1
  std::vector<std::int32_t> partner;
  std::vector<std::uint8_t> touching;  ///< 1 if any lane touched in the last step
  AlignedDoubles spring_m;             ///< [pair][3][W]: tangential displacement of j against i
  /// [pair][3][W]: rolling angle of j against i; empty where no lane has rolling friction.
  AlignedDoubles rolling_rad;
  AlignedDoubles effects;  ///< [pair][2][W]: plastic overlap [m], age [s]; empty where no effect acts
};

/// Wall contacts near enough to matter, sorted by wall, then particle.
struct WallContactMemory {
  std::vector<std::int32_t> row_begin;  ///< num_walls + 1
  std::vector<std::int32_t> particle;
  AlignedDoubles spring_m;  ///< [contact][3][W]: tangential displacement of the wall's grain
  AlignedDoubles rolling_rad;  ///< [contact][3][W]: rolling angle of the grain, or empty likewise
};

/// Tool contacts near enough to matter, sorted by tool, particle, feature.
struct ToolContactMemory {
  std::vector<std::int32_t> row_begin;  ///< num_tools + 1
  std::vector<std::int32_t> particle;
  std::vector<std::int32_t> feature;  ///< of mesh_features(mesh)
  AlignedDoubles spring_m;            ///< [contact][3][W]: displacement of the grain on the tool
};

struct State {
  int num_lanes = 1;
  /// [particle][9][W]: x y z [m], velocity [m/s], angular velocity [rad/s].
  AlignedDoubles motion;
  ContactMemory contacts;
  WallContactMemory wall_contacts;
  /// [bond][8][W]: shear force on i (3) [N], bending moment on i (3) [N m], twist moment [N m],
  /// 1 while the bond holds and 0 after it broke.
  AlignedDoubles bonds;
  AlignedDoubles bond_worst;       ///< [bond][W]: largest utilisation; empty where no effect acts
  AlignedDoubles walls;            ///< [wall][4][W]: position (3) [m], cylinder radius [m]
  /// [wall][6][W]: force on the wall and torque about its point in the last step (servos read it).
  AlignedDoubles wall_force;
  std::vector<WallDrive> drives;   ///< [wall][lane]
  ToolContactMemory tool_contacts;
  AlignedDoubles tools;  ///< [tool][7][W]: position of the origin (3) [m], orientation w x y z
  /// [tool][7][W]: force on the tool, torque about its origin, number of touching contacts, all of
  /// the last step.
  AlignedDoubles tool_load;
  std::vector<ToolDrive> tool_drives;  ///< [tool][lane]
  std::vector<double> time_s;      ///< per lane
  /// Per lane. A frozen lane keeps its motion, walls, tools, their forces, time and which bonds hold; contact
  /// springs may be dropped. After freezing by hand call model_changed().
  std::vector<std::uint8_t> active;
  std::int64_t num_steps = 0;

  Vec3 position_m(int particle, int lane = 0) const { return part(motion, particle, 9, 0, lane); }
  Vec3 velocity_m_per_s(int particle, int lane = 0) const { return part(motion, particle, 9, 3, lane); }
  Vec3 angular_velocity_rad_per_s(int particle, int lane = 0) const {
    return part(motion, particle, 9, 6, lane);
  }
  void set_position_m(int particle, const Vec3& x) { set_motion_part(particle, 0, x); }
  void set_velocity_m_per_s(int particle, const Vec3& v) { set_motion_part(particle, 3, v); }
  void set_angular_velocity_rad_per_s(int particle, const Vec3& w) {
    set_motion_part(particle, 6, w);
  }
  bool bond_holds(int bond, int lane = 0) const { return bonds[pack(bond, 8, 7) + at(lane)] > 0.5; }
  Vec3 wall_position_m(int wall, int lane = 0) const { return part(walls, wall, 4, 0, lane); }
  /// Force of the specimen on the wall in the last step.
  Vec3 wall_force_N(int wall, int lane = 0) const { return part(wall_force, wall, 6, 0, lane); }
  /// Torque of the specimen on the wall about the wall's point in the last step.
  Vec3 wall_torque_N_m(int wall, int lane = 0) const { return part(wall_force, wall, 6, 3, lane); }
  Vec3 tool_position_m(int tool, int lane = 0) const { return part(tools, tool, 7, 0, lane); }
  /// Body frame to world.
  Eigen::Quaterniond tool_orientation(int tool, int lane = 0) const;
  /// Puts one lane's tool elsewhere; then call model_changed().
  void set_tool_position_m(int tool, int lane, const Vec3& x);
  /// Force of the specimen on the tool in the last step.
  Vec3 tool_force_N(int tool, int lane = 0) const { return part(tool_load, tool, 7, 0, lane); }
  /// Torque of the specimen on the tool about its origin in the last step.
  Vec3 tool_torque_N_m(int tool, int lane = 0) const { return part(tool_load, tool, 7, 3, lane); }
  /// Touching contacts in the last step; a grain in a concave corner counts twice.
  int num_tool_contacts(int tool, int lane = 0) const {
    return static_cast<int>(tool_load[pack(tool, 7, 6) + at(lane)]);
  }
  ToolDrive& tool_drive(int tool, int lane) { return tool_drives[at(tool * num_lanes + lane)]; }
  WallDrive& drive(int wall, int lane) { return drives[at(wall * num_lanes + lane)]; }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  std::size_t pack(int item, int packs_per_item, int k) const {
    return (at(item) * at(packs_per_item) + at(k)) * at(num_lanes);
  }
  /// Three packs of an item's block, one lane.
  Vec3 part(const AlignedDoubles& block, int item, int packs_per_item, int first, int lane) const;
  void set_motion_part(int particle, int first, const Vec3& value);  ///< all lanes alike
};

/// Calls body(0) ... body(n - 1), perhaps side by side, and returns when all are done.
using SideBySide = std::function<void(std::size_t n, const std::function<void(std::size_t)>& body)>;

/// Rows that one thread of a step works on; see step_blocks.hpp.
struct StepBlock {
  std::int32_t row_from = 0, row_to = 0;
  std::int32_t cross_from = 0, cross_to = 0;  ///< cross pairs whose i lies in the block
  std::vector<std::int32_t> cross_in;         ///< those whose j does, ascending
};

/// Buffers rebuilt from Model and State whenever needed; see step().
struct Workspace {
  int num_threads = 1;      ///< of one step; any number gives the same bits
  SideBySide side_by_side;  ///< what runs them; empty: one thread
  bool prepared = false;
  bool has_rolling = false;  ///< rolling springs are kept: some lane has rolling friction, or effects
  bool has_effects = false;  ///< some lane has effects, or bonds have strengths of their own
  std::vector<PairRecord> pairs;
  std::vector<StepBlock> blocks;          ///< empty with one thread
  std::vector<std::int32_t> row_end;      ///< [particle]: end of the pairs inside its block
  std::vector<std::int32_t> cross_pair;   ///< pairs between blocks, ascending
  std::vector<std::int32_t> cross_row;    ///< their i
  AlignedDoubles cross_force;             ///< [cross pair][9][W]
  std::vector<std::uint8_t> cross_acts;
  AlignedDoubles block_max_speed2;        ///< [block][W], blocks a cache line apart
  AlignedDoubles block_num_broken;        ///< likewise
  std::vector<WallRecord> wall_pairs;
  std::vector<MeshFeatures> tool_features;
  std::vector<double> tool_reach_m;    ///< per tool: farthest a grain it may touch is from its origin
  std::vector<WallRecord> tool_pairs;
  AlignedDoubles tool_motion;          ///< [tool][18][W]: position, body axes, velocity, spin
  AlignedDoubles force;                ///< [particle][6][W]: force [N], torque [N m]
  AlignedDoubles law;                  ///< lane constants as packs
  std::vector<double> inverse_mass_per_kg;
  std::vector<double> inverse_inertia_per_kg_m2;
  AlignedDoubles max_speed2_m2_per_s2;  ///< [W], of the last step
  AlignedDoubles num_broken;           ///< [W], bonds broken since the start
  std::vector<double> moved_m;         ///< per lane: bound on the motion since the list was built
  std::int64_t num_rebuilds = 0;
  double skin_m = 0.0;              ///< motion that uses up the list
  double attraction_reach_m = 0.0;  ///< gap at which something may pull; pairs within skin + this are listed
};

/// State at rest at the given positions, no contact memory, all bonds holding.
State initial_state(const Model& model, const std::vector<Vec3>& position_m);

}  // namespace tilth
