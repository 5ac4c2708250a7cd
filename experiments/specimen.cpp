// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/specimen.hpp"

#include <algorithm>

#include "dem_core/neighbours.hpp"
#include "dem_core/time_step.hpp"
#include "dem_core/tool_geometry.hpp"
#include "dem_core/wall_geometry.hpp"

namespace tilth {
namespace {

std::size_t as_size(int k) { return static_cast<std::size_t>(k); }

void add_bonds_and_references(Model& model, const State& state, double mean_radius_m,
                              const BondingSpec& bonding) {
  const double gap_m = bonding.max_gap_over_radius * mean_radius_m;
  for (const ReferenceDistance& p : pairs_within(model, state, std::max(gap_m, 0.0))) {
    const double ri = model.radius_m[as_size(p.i)];
    const double rj = model.radius_m[as_size(p.j)];
    if (p.distance_m < ri + rj) model.references.push_back(p);
    if (p.distance_m < ri + rj + gap_m)
      model.bonds.push_back(parallel_bond(p.i, p.j, ri, rj, p.distance_m));
  }
}

void add_wall_references(Model& model, const State& state, double mean_radius_m,
                         const BondingSpec& bonding) {
  const double gap_m = std::max(bonding.max_gap_over_radius, 0.0) * mean_radius_m;
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w) {
    const bool glued = std::ranges::find(bonding.glued_walls, w) != bonding.glued_walls.end();
    for (int i = 0; i < model.num_particles(); ++i) {
      const double distance_m = wall_distance_m(model, state, w, state.position_m(i));
      if (distance_m < model.radius_m[as_size(i)] + (glued ? gap_m : 0.0))
        model.wall_references.push_back({w, i, distance_m, glued});
    }
  }
}

void add_tool_references(Model& model, const State& state) {
  for (int t = 0; t < static_cast<int>(model.tools.size()); ++t) {
    const Tool& tool = model.tools[as_size(t)];
    const MeshFeatures mesh = mesh_features(tool.mesh);
    for (int i = 0; i < model.num_particles(); ++i) {
      const double r = model.radius_m[as_size(i)];
      const double distance_m = tool_distance_m(tool, mesh, state.position_m(i), r);
      if (distance_m < r) model.tool_references.push_back({t, i, distance_m});
    }
  }
}

}  // namespace

Specimen make_specimen(const Packing& packing, std::span<const SoilMaterial> materials,
                       const std::vector<Wall>& walls, const BondingSpec& bonding,
                       const std::vector<Tool>& tools) {
  Specimen s;
  s.mean_radius_m = packing.mean_radius_m;
  s.model.radius_m = packing.radius_m;
  s.model.walls = walls;
  s.model.tools = tools;
  for (const SoilMaterial& m : materials) s.model.lanes.push_back(lane_law(m));
  // One mass serves all lanes; a member of other density differs only in inertia, which its time
  // step and platen speed scale out, so the first member's density stands for all.
  s.model.mass_kg = sphere_masses_kg(packing.radius_m, materials.front().density_kg_per_m3);
  const State placed = initial_state(s.model, packing.position_m);
  add_bonds_and_references(s.model, placed, packing.mean_radius_m, bonding);
  s.model.bond_strength = bond_strengths(s.model, packing, materials, bonding.place);
  add_wall_references(s.model, placed, packing.mean_radius_m, bonding);
  add_tool_references(s.model, placed);
  s.state = initial_state(s.model, packing.position_m);
  for (int lane = 0; lane < s.model.num_lanes(); ++lane)
    s.model.lanes[as_size(lane)].dt_s =
        ladder_time_step_s(0.8 * stable_time_step_s(s.model, s.state, lane));
  return s;
}

}  // namespace tilth
