// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dem_core/step_blocks.hpp"
#include "dem_core/tool_geometry.hpp"
#include "dem_core/wall_geometry.hpp"

namespace tilth {
namespace {

using Index = std::int32_t;
std::size_t as_size(std::int64_t k) { return static_cast<std::size_t>(k); }

/// Positions of one lane, contiguous.
std::vector<Vec3> lane_positions(const State& state, int num_particles, int lane) {
  std::vector<Vec3> x(as_size(num_particles));
  for (int i = 0; i < num_particles; ++i) x[as_size(i)] = state.position_m(i, lane);
  return x;
}

/// Cells at least as wide as the reach. Grains beyond four standard deviations are counted into the
/// outermost cells: clamping never moves two grains more cells apart, so no pair is missed.
struct Grid {
  Vec3 low = Vec3::Zero();
  Vec3 inverse_width_per_m = Vec3::Zero();
  std::array<Index, 3> size{1, 1, 1};
  std::vector<Index> cell_begin;
  std::vector<Index> members;

  Grid(const std::vector<Vec3>& x, double reach_m) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : x) mean += p;
    const double n = static_cast<double>(std::max<std::size_t>(x.size(), 1));
    mean /= n;
    Vec3 variance = Vec3::Zero();
    for (const Vec3& p : x) variance += (p - mean).cwiseAbs2();
    Vec3 half = 4 * (variance / n).cwiseSqrt() + Vec3::Constant(reach_m);
    low = mean - half;
    for (int k = 0; k < 3; ++k) {
      // fmax and fmin answer NaN (a diverged lane) with the bound
      const double cells = std::fmin(std::fmax(std::floor(2 * half[k] / reach_m), 1.0), 128.0);
      size[as_size(k)] = static_cast<Index>(cells);
      inverse_width_per_m[k] = cells / (2 * half[k]);
    }
    fill(x);
  }

  std::array<Index, 3> cell_of(const Vec3& p) const {
    std::array<Index, 3> c{};
    for (int k = 0; k < 3; ++k) {
      const double s = (p[k] - low[k]) * inverse_width_per_m[k];
      const double last = static_cast<double>(size[as_size(k)] - 1);
      c[as_size(k)] = s > 0 ? static_cast<Index>(std::min(s, last)) : 0;  // NaN goes to cell 0
    }
    return c;
  }

  Index flat(const std::array<Index, 3>& c) const {
    return (c[2] * size[1] + c[1]) * size[0] + c[0];
  }

  void fill(const std::vector<Vec3>& x) {
    const std::size_t cells = as_size(size[0]) * as_size(size[1]) * as_size(size[2]);
    cell_begin.assign(cells + 1, 0);
    std::vector<Index> cell(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      cell[i] = flat(cell_of(x[i]));
      ++cell_begin[as_size(cell[i]) + 1];
    }
    for (std::size_t c = 0; c < cells; ++c) cell_begin[c + 1] += cell_begin[c];
    members.resize(x.size());
    std::vector<Index> next(cell_begin.begin(), cell_begin.end() - 1);
    for (std::size_t i = 0; i < x.size(); ++i)
      members[as_size(next[as_size(cell[i])]++)] = static_cast<Index>(i);
  }

  /// Calls visit(i, j), i < j, for every pair in neighbouring cells.
  template <typename Visit>
  void for_each_candidate(const std::vector<Vec3>& x, Visit visit) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::array<Index, 3> c = cell_of(x[i]);
      const auto from = [&](int k) { return std::max(c[as_size(k)] - 1, 0); };
      const auto to = [&](int k) { return std::min(c[as_size(k)] + 1, size[as_size(k)] - 1); };
      for (Index cz = from(2); cz <= to(2); ++cz)
        for (Index cy = from(1); cy <= to(1); ++cy) {
          const Index first = cell_begin[as_size(flat({from(0), cy, cz}))];
          const Index last = cell_begin[as_size(flat({to(0), cy, cz})) + 1];
          for (Index m = first; m < last; ++m)
            if (const Index j = members[as_size(m)]; j > static_cast<Index>(i))
              visit(static_cast<Index>(i), j);
        }
    }
  }
};

double largest_radius_m(const Model& model) {
  return model.radius_m.empty() ? 0.0 : *std::ranges::max_element(model.radius_m);
}

/// Rows of partners j > i, sorted and unique: bonds of the model and near pairs of every lane.
struct Rows {
  std::vector<std::vector<Index>> partners;

  Rows(const Model& model, const State& state, double margin_m) : partners(model.radius_m.size()) {
    for (const BondGeometry& b : model.bonds) partners[as_size(b.i)].push_back(b.j);
    // a reference distance may exceed the radii: such pairs are always listed
    for (const ReferenceDistance& r : model.references)
      if (r.distance_m > model.radius_m[as_size(r.i)] + model.radius_m[as_size(r.j)])
        partners[as_size(r.i)].push_back(r.j);
    for (int lane = 0; lane < state.num_lanes; ++lane)
      if (state.active[as_size(lane)]) add_lane(model, state, margin_m, lane);
    for (auto& row : partners) {
      std::ranges::sort(row);
      row.erase(std::unique(row.begin(), row.end()), row.end());
    }
  }

  void add_lane(const Model& model, const State& state, double margin_m, int lane) {
    const std::vector<Vec3> x = lane_positions(state, model.num_particles(), lane);
    const Grid grid(x, 2 * largest_radius_m(model) + margin_m);
    grid.for_each_candidate(x, [&](Index i, Index j) {
      if (j < model.num_fixed) return;  // i < j: neither moves
      const double reach = model.radius_m[as_size(i)] + model.radius_m[as_size(j)] + margin_m;
      if ((x[as_size(j)] - x[as_size(i)]).squaredNorm() < reach * reach)
        partners[as_size(i)].push_back(j);
    });
  }
};

PairRecord pair_record(const Model& model, Index i, Index j) {
  const double ri = model.radius_m[as_size(i)];
  const double rj = model.radius_m[as_size(j)];
  const double mi = model.mass_kg[as_size(i)];
  const double mj = model.mass_kg[as_size(j)];
  const double r = std::min(ri, rj);
  const double stiffness =
      model.stiffness_kind == StiffnessKind::modulus ? M_PI * r * r / (ri + rj) : 1.0;
  const double mass = mi * mj / (mi + mj);
  const bool rate = model.damping_kind == DampingKind::rate;
  return {.j = j,
          .bond = -1,
          .reference_m = ri + rj,
          .stiffness_factor = stiffness,
          .damping_factor = rate ? mass : std::sqrt(mass * stiffness),
          .arm_offset_m = 0.5 * (ri - rj)};
}

/// Takes the memory of contact k over as that of contact m; nothing where there is no such memory.
void copy_memory(const AlignedDoubles& from, std::size_t k, AlignedDoubles& to, std::size_t m,
                 std::size_t num_values) {
  if (from.empty() || to.empty()) return;
  std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(k * num_values), num_values,
              to.begin() + static_cast<std::ptrdiff_t>(m * num_values));
}

void copy_spring(const AlignedDoubles& from, std::size_t k, AlignedDoubles& to, std::size_t m,
                 std::size_t lanes) {
  copy_memory(from, k, to, m, 3 * lanes);
}

void rebuild_pairs(const Model& model, State& state, Workspace& workspace) {
  const Rows rows(model, state, list_margin_m(workspace));
  const std::size_t lanes = as_size(state.num_lanes);
  ContactMemory fresh;
  fresh.row_begin.assign(rows.partners.size() + 1, 0);
  for (std::size_t i = 0; i < rows.partners.size(); ++i)
    fresh.row_begin[i + 1] = fresh.row_begin[i] + static_cast<Index>(rows.partners[i].size());
  const std::size_t total = as_size(fresh.row_begin.back());
  fresh.partner.reserve(total);
  fresh.touching.assign(total, 0);
  fresh.spring_m.assign(total * 3 * lanes, 0.0);
  if (workspace.has_rolling) fresh.rolling_rad.assign(total * 3 * lanes, 0.0);
  if (workspace.has_effects) fresh.effects.assign(total * 2 * lanes, 0.0);
  workspace.pairs.clear();
  workspace.pairs.reserve(total);
  const ContactMemory& old = state.contacts;
  std::size_t bond = 0;
  std::size_t reference = 0;
  for (std::size_t i = 0; i < rows.partners.size(); ++i) {
    std::size_t k = as_size(old.row_begin[i]);
    const std::size_t k_end = as_size(old.row_begin[i + 1]);
    const Index row = static_cast<Index>(i);
    const auto behind = [row](const auto& item, Index j) {
      return item.i < row || (item.i == row && item.j < j);
    };
    for (const Index j : rows.partners[i]) {
      PairRecord record = pair_record(model, row, j);
      while (bond < model.bonds.size() && behind(model.bonds[bond], j)) ++bond;
      if (bond < model.bonds.size() && model.bonds[bond].i == row && model.bonds[bond].j == j)
        record.bond = static_cast<Index>(bond);
      const auto& refs = model.references;
      while (reference < refs.size() && behind(refs[reference], j)) ++reference;
      if (reference < refs.size() && refs[reference].i == row && refs[reference].j == j)
        record.reference_m = refs[reference].distance_m;
      while (k < k_end && old.partner[k] < j) ++k;
      if (k < k_end && old.partner[k] == j) {
        copy_spring(old.spring_m, k, fresh.spring_m, fresh.partner.size(), lanes);
        copy_spring(old.rolling_rad, k, fresh.rolling_rad, fresh.partner.size(), lanes);
        copy_memory(old.effects, k, fresh.effects, fresh.partner.size(), 2 * lanes);
        fresh.touching[fresh.partner.size()] = old.touching[k];
      }
      fresh.partner.push_back(j);
      workspace.pairs.push_back(record);
    }
  }
  state.contacts = std::move(fresh);
}

/// Per grain its reference at this wall, or nullptr where contact begins at the radius.
std::vector<const WallReference*> references_of_wall(const Model& model, int wall) {
  std::vector<const WallReference*> of_particle(model.radius_m.size(), nullptr);
  for (const WallReference& r : model.wall_references)
    if (r.wall == wall) of_particle[as_size(r.particle)] = &r;
  return of_particle;
}

bool near_wall(const Model& model, const State& state, const Workspace& workspace, int wall,
               int particle) {
  const double reach = model.radius_m[as_size(particle)] + list_margin_m(workspace);
  for (int lane = 0; lane < state.num_lanes; ++lane)
    if (state.active[as_size(lane)] &&
        distance_to_reach_wall_m(model, state, wall, state.position_m(particle, lane), lane) < reach)
      return true;
  return false;
}

/// A grain against a rigid body, wall or tool.
WallRecord rigid_record(const Model& model, int particle, double reference_m, bool glued) {
  const double r = model.radius_m[as_size(particle)];
  const double mass = model.mass_kg[as_size(particle)];
  const double stiffness = model.stiffness_kind == StiffnessKind::modulus ? M_PI * r : 1.0;
  const bool rate = model.damping_kind == DampingKind::rate;
  return {reference_m, stiffness, rate ? mass : std::sqrt(mass * stiffness), glued};
}

WallRecord wall_record(const Model& model, int particle, const WallReference* reference) {
  const double touching_m = reference ? reference->distance_m : model.radius_m[as_size(particle)];
  return rigid_record(model, particle, touching_m, reference && reference->glued);
}

void rebuild_walls(const Model& model, State& state, Workspace& workspace) {
  const WallContactMemory old = std::move(state.wall_contacts);
  WallContactMemory fresh;
  const std::size_t lanes = as_size(state.num_lanes);
  fresh.row_begin.assign(model.walls.size() + 1, 0);
  workspace.wall_pairs.clear();
  for (int wall = 0; wall < static_cast<int>(model.walls.size()); ++wall) {
    std::size_t k = as_size(old.row_begin[as_size(wall)]);
    const std::size_t k_end = as_size(old.row_begin[as_size(wall) + 1]);
    const std::vector<const WallReference*> references = references_of_wall(model, wall);
    for (int i = 0; i < model.num_particles(); ++i) {
      const WallReference* reference = references[as_size(i)];
      const bool glued = reference && reference->glued;
      if (!glued && !near_wall(model, state, workspace, wall, i)) continue;
      fresh.particle.push_back(i);
      fresh.spring_m.resize(fresh.particle.size() * 3 * lanes, 0.0);
      if (workspace.has_rolling) fresh.rolling_rad.resize(fresh.spring_m.size(), 0.0);
      while (k < k_end && old.particle[k] < i) ++k;
      if (k < k_end && old.particle[k] == i) {
        copy_spring(old.spring_m, k, fresh.spring_m, fresh.particle.size() - 1, lanes);
        copy_spring(old.rolling_rad, k, fresh.rolling_rad, fresh.particle.size() - 1, lanes);
      }
      workspace.wall_pairs.push_back(wall_record(model, i, reference));
    }
    fresh.row_begin[as_size(wall) + 1] = static_cast<Index>(fresh.particle.size());
  }
  state.wall_contacts = std::move(fresh);
}

/// Features of a tool that a grain may touch before the next rebuild, in at least one active lane.
std::vector<Index> near_features(const Model& model, const State& state, const Workspace& workspace,
                                 int tool, int particle, double extent_m) {
  std::vector<Index> found;
  const double reach_m = model.radius_m[as_size(particle)] + list_margin_m(workspace);
  const MeshFeatures& mesh = workspace.tool_features[as_size(tool)];
  for (int lane = 0; lane < state.num_lanes; ++lane) {
    if (!state.active[as_size(lane)]) continue;
    const Vec3 arm = state.position_m(particle, lane) - state.tool_position_m(tool, lane);
    const double farthest_m = extent_m + reach_m;
    if (!(arm.squaredNorm() < farthest_m * farthest_m)) continue;
    const Vec3 x = to_body_frame(state, tool, state.position_m(particle, lane), lane);
    for (std::size_t f = 0; f < mesh.features.size(); ++f)
      if (feature_distance(mesh, f, x, reach_m, model.tools[as_size(tool)].max_depth_m,
                           list_margin_m(workspace)))
        found.push_back(static_cast<Index>(f));
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void rebuild_tools(const Model& model, State& state, Workspace& workspace) {
  const ToolContactMemory old = std::move(state.tool_contacts);
  ToolContactMemory fresh;
  const std::size_t lanes = as_size(state.num_lanes);
  fresh.row_begin.assign(model.tools.size() + 1, 0);
  workspace.tool_pairs.clear();
  for (std::size_t tool = 0; tool < model.tools.size(); ++tool) {
    std::size_t k = as_size(old.row_begin[tool]);
    const std::size_t k_end = as_size(old.row_begin[tool + 1]);
    const double extent_m = tool_extent_m(model.tools[tool]);
    for (Index i = 0; i < model.num_particles(); ++i)
      for (const Index f :
           near_features(model, state, workspace, static_cast<int>(tool), i, extent_m)) {
        fresh.particle.push_back(i);
        fresh.feature.push_back(f);
        fresh.spring_m.resize(fresh.particle.size() * 3 * lanes, 0.0);
        while (k < k_end && (old.particle[k] < i || (old.particle[k] == i && old.feature[k] < f)))
          ++k;
        if (k < k_end && old.particle[k] == i && old.feature[k] == f)
          copy_spring(old.spring_m, k, fresh.spring_m, fresh.particle.size() - 1, lanes);
        double reference_m = model.radius_m[as_size(i)];
        for (const ToolReference& r : model.tool_references)
          if (r.tool == static_cast<Index>(tool) && r.particle == i) reference_m = r.distance_m;
        workspace.tool_pairs.push_back(rigid_record(model, i, reference_m, false));
      }
    fresh.row_begin[tool + 1] = static_cast<Index>(fresh.particle.size());
  }
  state.tool_contacts = std::move(fresh);
}

}  // namespace

void rebuild_neighbours(const Model& model, State& state, Workspace& workspace) {
  rebuild_pairs(model, state, workspace);
  rebuild_walls(model, state, workspace);
  rebuild_tools(model, state, workspace);
  cut_into_blocks(state, workspace);
  workspace.moved_m.assign(as_size(state.num_lanes), 0.0);
  ++workspace.num_rebuilds;
}

std::vector<ReferenceDistance> pairs_within(const Model& model, const State& state, double gap_m,
                                            int lane) {
  const std::vector<Vec3> x = lane_positions(state, model.num_particles(), lane);
  const Grid grid(x, 2 * largest_radius_m(model) + std::max(gap_m, 0.0));
  std::vector<ReferenceDistance> found;
  grid.for_each_candidate(x, [&](Index i, Index j) {
    const double reach = model.radius_m[as_size(i)] + model.radius_m[as_size(j)] + gap_m;
    const double distance = (x[as_size(j)] - x[as_size(i)]).norm();
    if (distance < reach) found.push_back({i, j, distance});
  });
  std::ranges::sort(found, [](const auto& a, const auto& b) {
    return a.i != b.i ? a.i < b.i : a.j < b.j;
  });
  return found;
}

}  // namespace tilth
