// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/state.hpp"

namespace tilth {
namespace {

std::size_t as_size(int k) { return static_cast<std::size_t>(k); }

}  // namespace

Vec3 State::part(const AlignedDoubles& block, int item, int packs_per_item, int first,
                 int lane) const {
  const std::size_t p = pack(item, packs_per_item, first) + at(lane);
  const std::size_t w = at(num_lanes);
  return {block[p], block[p + w], block[p + 2 * w]};
}

Eigen::Quaterniond State::tool_orientation(int tool, int lane) const {
  const Vec3 imaginary = part(tools, tool, 7, 4, lane);
  return {tools[pack(tool, 7, 3) + at(lane)], imaginary.x(), imaginary.y(), imaginary.z()};
}

void State::set_motion_part(int particle, int first, const Vec3& value) {
  for (int k = 0; k < 3; ++k)
    for (int lane = 0; lane < num_lanes; ++lane)
      motion[pack(particle, 9, first + k) + at(lane)] = value[k];
}

void State::set_tool_position_m(int tool, int lane, const Vec3& x) {
  for (int k = 0; k < 3; ++k) tools[pack(tool, 7, k) + at(lane)] = x[k];
}

State initial_state(const Model& model, const std::vector<Vec3>& position_m) {
  State state;
  const std::size_t w = model.lanes.size();
  const std::size_t n = position_m.size();
  state.num_lanes = model.num_lanes();
  state.motion.assign(n * 9 * w, 0.0);
  for (int i = 0; i < static_cast<int>(n); ++i) state.set_position_m(i, position_m[as_size(i)]);
  state.contacts.row_begin.assign(n + 1, 0);
  state.wall_contacts.row_begin.assign(model.walls.size() + 1, 0);
  state.bonds.assign(model.bonds.size() * 8 * w, 0.0);
  for (std::size_t b = 0; b < model.bonds.size(); ++b)
    for (std::size_t lane = 0; lane < w; ++lane) state.bonds[(b * 8 + 7) * w + lane] = 1.0;
  state.walls.assign(model.walls.size() * 4 * w, 0.0);
  for (std::size_t wall = 0; wall < model.walls.size(); ++wall)
    for (std::size_t lane = 0; lane < w; ++lane) {
      for (int k = 0; k < 3; ++k)
        state.walls[(wall * 4 + as_size(k)) * w + lane] = model.walls[wall].position_m[k];
      state.walls[(wall * 4 + 3) * w + lane] = model.walls[wall].radius_m;
    }
  state.wall_force.assign(model.walls.size() * 6 * w, 0.0);
  state.drives.assign(model.walls.size() * w, WallDrive{});
  state.tool_contacts.row_begin.assign(model.tools.size() + 1, 0);
  for (const Tool& tool : model.tools) {
    const Eigen::Quaterniond q = tool.orientation.normalized();
    for (const double x : {tool.position_m.x(), tool.position_m.y(), tool.position_m.z(), q.w(),
                           q.x(), q.y(), q.z()})
      state.tools.insert(state.tools.end(), w, x);
  }
  state.tool_load.assign(model.tools.size() * 7 * w, 0.0);
  state.tool_drives.assign(model.tools.size() * w, ToolDrive{});
  state.time_s.assign(w, 0.0);
  state.active.assign(w, 1);
  return state;
}

}  // namespace tilth
