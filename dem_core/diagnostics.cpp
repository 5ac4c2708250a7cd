// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/diagnostics.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "dem_core/tool_geometry.hpp"
#include "dem_core/wall_geometry.hpp"

namespace tilth {
namespace {

std::size_t as_size(std::int64_t k) { return static_cast<std::size_t>(k); }

Vec3 stored_vector(const AlignedDoubles& data, std::size_t first_pack, std::size_t lanes,
                   std::size_t lane) {
  const std::size_t p = first_pack * lanes + lane;
  return {data[p], data[p + lanes], data[p + 2 * lanes]};
}

double ratio_or_zero(double a, double b) { return b > 0 ? a / b : 0.0; }

double bond_energy_J(const LaneLaw& law, const BondGeometry& g, double distance_m,
                     const AlignedDoubles& bonds, std::size_t b, std::size_t lanes,
                     std::size_t lane) {
  const Vec3 shear_N = stored_vector(bonds, b * 8, lanes, lane);
  const Vec3 bending_N_m = stored_vector(bonds, b * 8 + 3, lanes, lane);
  const double twisting_N_m = bonds[(b * 8 + 6) * lanes + lane];
  const double stretch_m = distance_m - g.rest_length_m;
  return 0.5 * (law.bond.normal_scale * g.normal_factor * stretch_m * stretch_m +
                ratio_or_zero(shear_N.squaredNorm(), law.bond.shear_scale * g.shear_factor) +
                ratio_or_zero(bending_N_m.squaredNorm(), law.bond.bending_scale * g.bending_factor) +
                ratio_or_zero(twisting_N_m * twisting_N_m,
                              law.bond.twisting_scale * g.twisting_factor));
}

/// Rolling angle of contact k; zero where no lane has rolling friction.
Vec3 rolling_angle_rad(const AlignedDoubles& rolling_rad, std::size_t k, std::size_t lanes,
                       std::size_t lane) {
  return rolling_rad.empty() ? Vec3::Zero() : stored_vector(rolling_rad, k * 3, lanes, lane);
}

/// The tangential and the rolling spring have one stiffness k_s per arc length: `sliding_and_rolling_m2`
/// is |s|^2 + Rbar^2 |angle|^2.
double spring_energy_J(const LaneLaw& law, double stiffness_factor, double overlap_m,
                       double sliding_and_rolling_m2) {
  const double kn = law.contact_stiffness * stiffness_factor;
  return 0.5 * kn * (overlap_m * overlap_m + law.shear_stiffness_ratio * sliding_and_rolling_m2);
}

}  // namespace

Energy energy(const Model& model, const State& state, const Workspace& workspace, int lane_id) {
  Energy e;
  const std::size_t lane = as_size(lane_id);
  const std::size_t lanes = as_size(state.num_lanes);
  const LaneLaw& law = model.lanes[lane];
  for (int i = 0; i < model.num_particles(); ++i) {
    const double m = model.mass_kg[as_size(i)];
    const double r = model.radius_m[as_size(i)];
    const double inertia = 0.4 * m * r * r;
    e.kinetic_J += 0.5 * m * state.velocity_m_per_s(i, lane_id).squaredNorm() +
                   0.5 * inertia * state.angular_velocity_rad_per_s(i, lane_id).squaredNorm();
    e.gravity_J -= m * model.gravity_m_per_s2.dot(state.position_m(i, lane_id));
    for (auto p = as_size(state.contacts.row_begin[as_size(i)]);
         p < as_size(state.contacts.row_begin[as_size(i) + 1]); ++p) {
      const PairRecord& pair = workspace.pairs[p];
      const double distance_m =
          (state.position_m(pair.j, lane_id) - state.position_m(i, lane_id)).norm();
      const bool held = pair.bond >= 0 && state.bond_holds(pair.bond, lane_id);
      if (held)
        e.bonds_J += bond_energy_J(law, model.bonds[as_size(pair.bond)], distance_m, state.bonds,
                                   as_size(pair.bond), lanes, lane);
      if (distance_m < pair.reference_m && (!held || model.contact_beside_bond))
        e.contacts_J += spring_energy_J(
            law, pair.stiffness_factor, pair.reference_m - distance_m,
            stored_vector(state.contacts.spring_m, p * 3, lanes, lane).squaredNorm() +
                std::pow(rolling_radius_m(model, i, pair.j), 2) *
                    rolling_angle_rad(state.contacts.rolling_rad, p, lanes, lane).squaredNorm());
    }
  }
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w)
    for (auto c = as_size(state.wall_contacts.row_begin[as_size(w)]);
         c < as_size(state.wall_contacts.row_begin[as_size(w) + 1]); ++c) {
      const Vec3 x = state.position_m(state.wall_contacts.particle[c], lane_id);
      const WallRecord& record = workspace.wall_pairs[c];
      const double overlap_m =
          record.reference_m - wall_distance_m(model, state, w, x, lane_id);
      if (overlap_m > 0 || record.glued)
        e.walls_J += spring_energy_J(
            law, record.stiffness_factor, overlap_m,
            stored_vector(state.wall_contacts.spring_m, c * 3, lanes, lane).squaredNorm() +
                std::pow(model.radius_m[as_size(state.wall_contacts.particle[c])], 2) *
                    rolling_angle_rad(state.wall_contacts.rolling_rad, c, lanes, lane).squaredNorm());
    }
  for (std::size_t t = 0; t < model.tools.size(); ++t)
    for (auto c = as_size(state.tool_contacts.row_begin[t]);
         c < as_size(state.tool_contacts.row_begin[t + 1]); ++c) {
      const Vec3 x = state.position_m(state.tool_contacts.particle[c], lane_id);
      const WallRecord& record = workspace.tool_pairs[c];
      const auto d = feature_distance(
          workspace.tool_features[t], as_size(state.tool_contacts.feature[c]),
          to_body_frame(state, static_cast<int>(t), x, lane_id), record.reference_m,
          model.tools[t].max_depth_m);
      if (d)
        e.tools_J += spring_energy_J(
            law, record.stiffness_factor, record.reference_m - d->distance_m,
            stored_vector(state.tool_contacts.spring_m, c * 3, lanes, lane).squaredNorm());
    }
  return e;
}

Vec3 momentum_kg_m_per_s(const Model& model, const State& state, int lane) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < model.num_particles(); ++i)
    sum += model.mass_kg[as_size(i)] * state.velocity_m_per_s(i, lane);
  return sum;
}

Vec3 angular_momentum_kg_m2_per_s(const Model& model, const State& state, int lane) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < model.num_particles(); ++i) {
    const double m = model.mass_kg[as_size(i)];
    const double r = model.radius_m[as_size(i)];
    sum += m * state.position_m(i, lane).cross(state.velocity_m_per_s(i, lane)) +
           0.4 * m * r * r * state.angular_velocity_rad_per_s(i, lane);
  }
  return sum;
}

int num_bonds_held(const Model& model, const State& state, int lane) {
  int held = 0;
  for (int b = 0; b < static_cast<int>(model.bonds.size()); ++b)
    held += state.bond_holds(b, lane) ? 1 : 0;
  return held;
}

double coordination(const Model& model, const State& state, int lane) {
  std::int64_t touching = 0;
  for (int i = 0; i < model.num_particles(); ++i)
    for (auto p = as_size(state.contacts.row_begin[as_size(i)]);
         p < as_size(state.contacts.row_begin[as_size(i) + 1]); ++p) {
      const int j = state.contacts.partner[p];
      const double reach = model.radius_m[as_size(i)] + model.radius_m[as_size(j)];
      touching += (state.position_m(j, lane) - state.position_m(i, lane)).norm() < reach ? 1 : 0;
    }
  for (std::size_t b = 0; b < model.bonds.size(); ++b) {
    const BondGeometry& bond = model.bonds[b];
    const double reach = model.radius_m[as_size(bond.i)] + model.radius_m[as_size(bond.j)];
    const bool apart =
        (state.position_m(bond.j, lane) - state.position_m(bond.i, lane)).norm() >= reach;
    touching += apart && state.bond_holds(static_cast<int>(b), lane) ? 1 : 0;
  }
  return 2.0 * static_cast<double>(touching) / std::max(1, model.num_particles());
}

}  // namespace tilth
