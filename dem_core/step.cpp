// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "dem_core/neighbours.hpp"
#include "dem_core/tool_geometry.hpp"
#include "dem_core/view_kernel.hpp"

namespace tilth {
namespace {

std::size_t as_size(std::int64_t k) { return static_cast<std::size_t>(k); }

void write_law(const Model& model, const State& state, Workspace& workspace) {
  using namespace lanes;
  const std::size_t w = model.lanes.size();
  workspace.law.assign(as_size(num_law_rows) * w, 0.0);
  for (std::size_t k = 0; k < w; ++k) {
    const LaneLaw& law = model.lanes[k];
    const auto put = [&](LawRow row, double value) { workspace.law[as_size(row) * w + k] = value; };
    const double damping_scale =
        model.damping_kind == DampingKind::restitution ? std::sqrt(law.contact_stiffness) : 1.0;
    const bool active = state.active[k] != 0;
    put(law_contact_stiffness, law.contact_stiffness);
    put(law_shear_ratio, law.shear_stiffness_ratio);
    put(law_inverse_shear_ratio, 1 / law.shear_stiffness_ratio);
    put(law_friction, law.friction);
    put(law_wall_friction, law.wall_friction);
    put(law_rolling_friction, law.rolling_friction);
    put(law_tool_friction, law.tool_friction);
    put(law_normal_damping, law.normal_damping * damping_scale);
    put(law_tangential_damping, law.tangential_damping * damping_scale);
    put(law_local_damping, law.local_damping);
    put(law_dt, active ? law.dt_s : 0.0);
    put(law_bond_normal, law.bond.normal_scale);
    put(law_bond_shear, law.bond.shear_scale);
    put(law_bond_bending, law.bond.bending_scale);
    put(law_bond_twisting, law.bond.twisting_scale);
    put(law_tensile_limit, law.bond.tensile_limit);
    put(law_cohesion_limit, law.bond.cohesion_limit);
    put(law_tan_friction, law.bond.tan_friction);
    put(law_bending_in_tension, law.bond.bending_in_tension);
    put(law_twisting_in_shear, law.bond.twisting_in_shear);
    put(law_bond_softening, law.effects.bond_softening);
    put(law_rate_strengthening, law.effects.rate_strengthening);
    put(law_rate_reference, law.effects.rate_reference_per_s);
    put(law_capillary, law.effects.capillary_Pa);
    put(law_healing, law.effects.healing_Pa);
    put(law_healing_time, law.effects.healing_time_s);
    put(law_tool_adhesion, law.effects.tool_adhesion_Pa);
    put(law_stiffness_exponent, law.effects.stiffness_exponent);
    put(law_reference_pressure, law.effects.reference_pressure_Pa);
    put(law_contact_plasticity, law.effects.contact_plasticity);
    put(law_crushing_compliance, law.effects.crushing_compliance_per_Pa);
    put(law_active, active ? 1.0 : 0.0);
  }
}

void prepare(const Model& model, State& state, Workspace& workspace) {
  const std::size_t w = model.lanes.size();
  const std::size_t n = model.radius_m.size();
  workspace.skin_m = model.skin_m > 0 ? model.skin_m
                     : n == 0         ? 0.0
                                      : 0.3 * *std::ranges::min_element(model.radius_m);
  workspace.force.assign(n * 6 * w, 0.0);
  workspace.max_speed2_m2_per_s2.assign(w, 0.0);
  if (workspace.num_broken.size() != w) workspace.num_broken.assign(w, 0.0);
  workspace.inverse_mass_per_kg.resize(n);
  workspace.inverse_inertia_per_kg_m2.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (i < as_size(model.num_fixed)) {  // no force or weight moves it
      workspace.inverse_mass_per_kg[i] = workspace.inverse_inertia_per_kg_m2[i] = 0.0;
      continue;
    }
    workspace.inverse_mass_per_kg[i] = 1 / model.mass_kg[i];
    workspace.inverse_inertia_per_kg_m2[i] =
        1 / (0.4 * model.mass_kg[i] * model.radius_m[i] * model.radius_m[i]);
  }
  const auto any_lane = [&model](auto has) { return std::ranges::any_of(model.lanes, has); };
  workspace.has_effects = !model.bond_strength.empty() ||
                          any_lane([](const LaneLaw& law) { return acts(law.effects); });
  workspace.has_rolling = workspace.has_effects ||
                          any_lane([](const LaneLaw& law) { return law.rolling_friction > 0; });
  if (workspace.has_effects) state.bond_worst.resize(model.bonds.size() * w, 0.0);
  const double r_max = n == 0 ? 0.0 : *std::ranges::max_element(model.radius_m);
  const bool attracting = any_lane([](const LaneLaw& law) { return attracts(law.effects); });
  workspace.attraction_reach_m = attracting ? attraction_range_over_radius * r_max : 0.0;
  write_law(model, state, workspace);
  workspace.tool_features.clear();
  workspace.tool_reach_m.clear();
  for (const Tool& tool : model.tools) {
    workspace.tool_features.push_back(mesh_features(tool.mesh));
    workspace.tool_reach_m.push_back(tool_extent_m(tool) + r_max + list_margin_m(workspace));
  }
  rebuild_neighbours(model, state, workspace);
  workspace.prepared = true;
}

/// Velocity of a wall in this step; updates the servo's integral. See WallDrive.
Vec3 drive_velocity(WallDrive& drive, const Wall& wall, const Vec3& force_on_wall_N, double dt_s) {
  if (drive.servo_gain_m_per_N_s <= 0) return drive.velocity_m_per_s;
  const double limit = drive.max_speed_m_per_s;
  // The specimen pushes against the normal.
  const double error_N = drive.target_force_N + force_on_wall_N.dot(wall.direction);
  const double integral =
      std::clamp(drive.velocity_m_per_s.dot(wall.direction) +
                     drive.servo_integral_gain_m_per_N_s2 * error_N * dt_s,
                 -limit, limit);
  const Vec3 sideways = drive.velocity_m_per_s -
                        drive.velocity_m_per_s.dot(wall.direction) * wall.direction;
  drive.velocity_m_per_s = sideways + integral * wall.direction;
  const double speed = drive.servo_gain_m_per_N_s * error_N + integral;
  return sideways + std::clamp(speed, -limit, limit) * wall.direction;
}

/// Moves every wall of every active lane; returns the wall velocities as packs.
AlignedDoubles move_walls(const Model& model, State& state, Workspace& workspace) {
  const std::size_t w = model.lanes.size();
  AlignedDoubles velocity(model.walls.size() * 4 * w, 0.0);
  for (std::size_t wall = 0; wall < model.walls.size(); ++wall)
    for (std::size_t lane = 0; lane < w; ++lane) {
      if (!state.active[lane]) continue;
      WallDrive& drive = state.drives[wall * w + lane];
      const double dt_s = model.lanes[lane].dt_s;
      const Vec3 v = drive_velocity(
          drive, model.walls[wall],
          state.wall_force_N(static_cast<int>(wall), static_cast<int>(lane)), dt_s);
      for (std::size_t k = 0; k < 3; ++k) {
        velocity[(wall * 4 + k) * w + lane] = v[static_cast<Eigen::Index>(k)];
        state.walls[(wall * 4 + k) * w + lane] += dt_s * v[static_cast<Eigen::Index>(k)];
      }
      velocity[(wall * 4 + 3) * w + lane] = drive.radial_velocity_m_per_s;
      state.walls[(wall * 4 + 3) * w + lane] += dt_s * drive.radial_velocity_m_per_s;
      const double speed = v.norm() + std::abs(drive.radial_velocity_m_per_s);
      workspace.moved_m[lane] += dt_s * speed;
    }
  return velocity;
}

/// Turns a body by angular velocity x dt, exactly for a constant axis.
Eigen::Quaterniond turned(const Eigen::Quaterniond& q, const Vec3& angular_velocity_rad_per_s,
                          double dt_s) {
  const double speed = angular_velocity_rad_per_s.norm();
  if (speed == 0) return q;
  const double half_rad = 0.5 * speed * dt_s;
  Eigen::Quaterniond step;
  step.w() = std::cos(half_rad);
  step.vec() = std::sin(half_rad) / speed * angular_velocity_rad_per_s;
  return (step * q).normalized();
}

/// Moves every tool of every active lane and writes its pose and motion for the kernel.
void move_tools(const Model& model, State& state, Workspace& workspace) {
  const std::size_t w = model.lanes.size();
  workspace.tool_motion.assign(model.tools.size() * 18 * w, 0.0);
  for (std::size_t tool = 0; tool < model.tools.size(); ++tool)
    for (std::size_t lane = 0; lane < w; ++lane) {
      const int t = static_cast<int>(tool);
      const int l = static_cast<int>(lane);
      ToolDrive drive = state.tool_drives[tool * w + lane];
      if (!state.active[lane]) drive = {};
      const double dt_s = model.lanes[lane].dt_s;
      const Vec3 position_m = state.tool_position_m(t, l) + dt_s * drive.velocity_m_per_s;
      const Eigen::Quaterniond q =
          turned(state.tool_orientation(t, l), drive.angular_velocity_rad_per_s, dt_s);
      const Eigen::Matrix3d axes = q.toRotationMatrix();
      const auto pose = [&](std::size_t k) -> double& {
        return state.tools[(tool * 7 + k) * w + lane];
      };
      const auto motion = [&](std::size_t k) -> double& {
        return workspace.tool_motion[(tool * 18 + k) * w + lane];
      };
      const std::array<double, 4> wxyz = {q.w(), q.x(), q.y(), q.z()};
      for (std::size_t k = 0; k < 4; ++k) pose(3 + k) = wxyz[k];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        motion(k) = pose(k) = position_m[row];
        for (Eigen::Index axis = 0; axis < 3; ++axis)
          motion(3 + 3 * static_cast<std::size_t>(axis) + k) = axes(row, axis);
        motion(12 + k) = drive.velocity_m_per_s[row];
        motion(15 + k) = drive.angular_velocity_rad_per_s[row];
      }
      const double spin = drive.angular_velocity_rad_per_s.norm();
      const double speed = drive.velocity_m_per_s.norm() + spin * workspace.tool_reach_m[tool];
      workspace.moved_m[lane] += dt_s * speed;
    }
}

/// moved_m bounds the sum of grain, wall and tool motion per lane; only when that bound uses up the skin
/// are the true displacements looked at.
bool list_ran_short(const State& state, Workspace& workspace) {
  double bound = 0.0;
  for (std::size_t lane = 0; lane < state.active.size(); ++lane)
    if (state.active[lane]) bound = std::max(bound, workspace.moved_m[lane]);
  return 2 * bound >= workspace.skin_m;
}

lanes::StepView view_of(const Model& model, State& state, Workspace& workspace,
                        const std::vector<lanes::WallView>& walls, const double* wall_velocity,
                        const std::vector<lanes::ToolView>& tools) {
  lanes::StepView v{};
  v.num_particles = model.num_particles();
  v.num_walls = static_cast<int>(model.walls.size());
  v.num_bonds = static_cast<int>(model.bonds.size());
  v.contact_beside_bond = model.contact_beside_bond;
  v.has_rolling = workspace.has_rolling;
  v.has_effects = workspace.has_effects;
  v.law = workspace.law.data();
  v.motion = state.motion.data();
  v.force = workspace.force.data();
  v.mass_kg = model.mass_kg.data();
  v.inverse_mass_per_kg = workspace.inverse_mass_per_kg.data();
  v.inverse_inertia_per_kg_m2 = workspace.inverse_inertia_per_kg_m2.data();
  v.radius_m = model.radius_m.data();
  for (int k = 0; k < 3; ++k) v.gravity_m_per_s2[k] = model.gravity_m_per_s2[k];
  v.row_begin = state.contacts.row_begin.data();
  v.row_end = workspace.blocks.empty() ? state.contacts.row_begin.data() + 1 : workspace.row_end.data();
  v.cross_pair = workspace.cross_pair.data();
  v.cross_row = workspace.cross_row.data();
  v.cross_force = workspace.cross_force.data();
  v.cross_acts = workspace.cross_acts.data();
  v.pairs = workspace.pairs.data();
  v.touching = state.contacts.touching.data();
  v.pair_spring_m = state.contacts.spring_m.data();
  v.pair_rolling_rad = state.contacts.rolling_rad.data();
  v.pair_effects = state.contacts.effects.data();
  v.bond_strength = model.bond_strength.empty() ? nullptr : model.bond_strength.data();
  v.bond_worst = state.bond_worst.data();
  v.bond_geometry = model.bonds.data();
  v.bonds = state.bonds.data();
  v.wall_row_begin = state.wall_contacts.row_begin.data();
  v.wall_particle = state.wall_contacts.particle.data();
  v.wall_pairs = workspace.wall_pairs.data();
  v.wall_spring_m = state.wall_contacts.spring_m.data();
  v.wall_rolling_rad = state.wall_contacts.rolling_rad.data();
  v.wall_views = walls.data();
  v.walls = state.walls.data();
  v.wall_velocity = wall_velocity;
  v.wall_force = state.wall_force.data();
  v.num_tools = static_cast<int>(model.tools.size());
  v.tool_row_begin = state.tool_contacts.row_begin.data();
  v.tool_particle = state.tool_contacts.particle.data();
  v.tool_feature = state.tool_contacts.feature.data();
  v.tool_pairs = workspace.tool_pairs.data();
  v.tool_spring_m = state.tool_contacts.spring_m.data();
  v.tool_views = tools.data();
  v.tool_motion = workspace.tool_motion.data();
  v.tool_load = state.tool_load.data();
  v.max_speed2 = workspace.max_speed2_m2_per_s2.data();
  v.num_broken = workspace.num_broken.data();
  return v;
}

std::vector<lanes::WallView> wall_views(const Model& model) {
  std::vector<lanes::WallView> views;
  views.reserve(model.walls.size());
  for (const Wall& wall : model.walls) {
    lanes::WallView v{};
    v.cylinder = wall.shape == WallShape::cylinder;
    v.bounded = wall.bounded();
    v.has_edges = wall.has_edges;
    for (int k = 0; k < 3; ++k) {
      v.direction[k] = wall.direction[k];
      v.tangent_a[k] = wall.tangent_a[k];
      v.tangent_b[k] = wall.tangent_b[k];
    }
    v.half_a_m = wall.half_a_m;
    v.half_b_m = wall.half_b_m;
    v.friction_scale = wall.friction_scale;
    v.adhesion_scale = wall.adhesion_scale;
    views.push_back(v);
  }
  return views;
}

std::vector<lanes::ToolView> tool_views(const Model& model, const Workspace& workspace) {
  std::vector<lanes::ToolView> views;
  for (std::size_t t = 0; t < model.tools.size(); ++t)
    views.push_back({workspace.tool_features[t].features.data(),
                     workspace.tool_features[t].half_spaces.data(), model.tools[t].max_depth_m});
  return views;
}

/// The kernels of one lane count, with or without the laws of effect_law.hpp.
struct Kernels {
  void (*step)(const lanes::StepView&);
  void (*cross_forces)(const lanes::StepView&, const lanes::BlockView&, std::int64_t, std::int64_t);
  void (*block_forces)(const lanes::StepView&, const lanes::BlockView&);
  void (*rigid_forces)(const lanes::StepView&);
  void (*move_block)(const lanes::StepView&, const lanes::BlockView&);
};

template <int W>
Kernels kernels_of(bool has_effects) {
  using namespace lanes;
  if (has_effects)
    return {step_lanes_with_effects<W>, BlockStepWithEffects<W>::cross_forces, BlockStepWithEffects<W>::block_forces,
            BlockStepWithEffects<W>::rigid_forces, BlockStep<W>::move_block};
  return {step_lanes<W>, BlockStep<W>::cross_forces, BlockStep<W>::block_forces, BlockStep<W>::rigid_forces,
          BlockStep<W>::move_block};
}

Kernels kernels(int num_lanes, bool has_effects) {
  if (!lanes_supported(num_lanes))
    throw std::invalid_argument("this processor cannot run that many lanes; see widest_lanes()");
  if (num_lanes == 1) return kernels_of<1>(has_effects);
  return num_lanes == 4 ? kernels_of<4>(has_effects) : kernels_of<8>(has_effects);
}

/// Blocks write their counts this far apart: no two share a cache line.
constexpr std::size_t counts_apart = 16;

std::vector<lanes::BlockView> block_views(Workspace& workspace) {
  const std::size_t size = workspace.blocks.size() * counts_apart;
  workspace.block_max_speed2.assign(size, 0.0);
  workspace.block_num_broken.assign(size, 0.0);
  std::vector<lanes::BlockView> views;
  for (std::size_t b = 0; b < workspace.blocks.size(); ++b) {
    const StepBlock& block = workspace.blocks[b];
    views.push_back({block.row_from, block.row_to, block.cross_from, block.cross_to, block.cross_in.data(),
                     static_cast<std::int64_t>(block.cross_in.size()),
                     workspace.block_max_speed2.data() + b * counts_apart,
                     workspace.block_num_broken.data() + b * counts_apart});
  }
  return views;
}

/// See step_blocks.hpp.
void step_side_by_side(const Kernels& kernels, const lanes::StepView& view, Workspace& workspace) {
  const std::vector<lanes::BlockView> blocks = block_views(workspace);
  const auto num_cross = static_cast<std::int64_t>(workspace.cross_pair.size());
  const auto num_blocks = static_cast<std::int64_t>(blocks.size());
  workspace.side_by_side(blocks.size(), [&](std::size_t b) {
    const auto share = static_cast<std::int64_t>(b);
    kernels.cross_forces(view, blocks[b], num_cross * share / num_blocks, num_cross * (share + 1) / num_blocks);
  });
  workspace.side_by_side(blocks.size(), [&](std::size_t b) { kernels.block_forces(view, blocks[b]); });
  kernels.rigid_forces(view);
  workspace.side_by_side(blocks.size(), [&](std::size_t b) { kernels.move_block(view, blocks[b]); });
  for (std::size_t lane = 0; lane < workspace.num_broken.size(); ++lane) {
    double& fastest = workspace.max_speed2_m2_per_s2[lane] = 0.0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      fastest = std::max(fastest, workspace.block_max_speed2[b * counts_apart + lane]);
      workspace.num_broken[lane] += workspace.block_num_broken[b * counts_apart + lane];
    }
  }
}

void run_kernels(const lanes::StepView& view, int num_lanes, Workspace& workspace) {
  const Kernels kernels_of_pack = kernels(num_lanes, view.has_effects);
  if (workspace.blocks.empty()) kernels_of_pack.step(view);
  else step_side_by_side(kernels_of_pack, view, workspace);
}

/// Books time and motion of every active lane; freezes those that ran away.
void close_step(const Model& model, State& state, Workspace& workspace, StepInfo& info) {
  const double limit_m =
      model.radius_m.empty() ? 0.0 : 0.25 * *std::ranges::min_element(model.radius_m);
  info.any_active = false;
  for (std::size_t lane = 0; lane < state.active.size(); ++lane) {
    if (!state.active[lane]) continue;
    const double dt_s = model.lanes[lane].dt_s;
    const double moved_m = dt_s * std::sqrt(workspace.max_speed2_m2_per_s2[lane]);
    state.time_s[lane] += dt_s;
    workspace.moved_m[lane] += moved_m;
    if (moved_m < limit_m) {
      info.any_active = true;
      continue;
    }
    state.active[lane] = 0;
    info.lane_failed = true;
    model_changed(workspace);
  }
  ++state.num_steps;
}

/// The kernel computes all lanes; a frozen one keeps the forces on walls and tools it had.
void restore_frozen(const State& state, const AlignedDoubles& before, AlignedDoubles& now) {
  const std::size_t w = state.active.size();
  for (std::size_t k = 0; k < before.size(); ++k)
    if (!state.active[k % w]) now[k] = before[k];
}

}  // namespace

void model_changed(Workspace& workspace) { workspace.prepared = false; }

int widest_lanes() {
  // what step_w8.cpp is compiled for
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return 8;
  if (__builtin_cpu_supports("avx2")) return 4;
  return 1;
}

bool lanes_supported(int num_lanes) {
  return num_lanes == 1 || ((num_lanes == 4 || num_lanes == 8) && num_lanes <= widest_lanes());
}

StepInfo step(const Model& model, State& state, Workspace& workspace) {
  StepInfo info;
  if (!workspace.prepared) prepare(model, state, workspace);
  const AlignedDoubles wall_velocity = move_walls(model, state, workspace);
  move_tools(model, state, workspace);
  if (list_ran_short(state, workspace)) {
    rebuild_neighbours(model, state, workspace);
    info.rebuilt = true;
  }
  const std::vector<lanes::WallView> walls = wall_views(model);
  const bool any_frozen = std::ranges::find(state.active, 0) != state.active.end();
  const AlignedDoubles wall_force = any_frozen ? state.wall_force : AlignedDoubles{};
  const AlignedDoubles tool_load = any_frozen ? state.tool_load : AlignedDoubles{};
  const std::vector<lanes::ToolView> tools = tool_views(model, workspace);
  run_kernels(view_of(model, state, workspace, walls, wall_velocity.data(), tools), model.num_lanes(), workspace);
  restore_frozen(state, wall_force, state.wall_force);
  restore_frozen(state, tool_load, state.tool_load);
  close_step(model, state, workspace, info);
  return info;
}

}  // namespace tilth
