// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/time_step.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem_core/neighbours.hpp"
#include "dem_core/tool_geometry.hpp"
#include "dem_core/wall_geometry.hpp"

namespace tilth {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Mat3 = Eigen::Matrix3d;

std::size_t as_size(int k) { return static_cast<std::size_t>(k); }

struct PairStiffness {
  double normal = 0.0, shear = 0.0, bending = 0.0, twisting = 0.0;
};

/// What one contact adds: springs (the rolling one bends), and dashpots as if they were springs.
struct ContactMatrices {
  PairStiffness springs, dashpots;
};

/// Sums over the contacts of one grain; Load[0] of springs, Load[1] of dashpots.
using Load = std::array<Matrix6, 2>;

/// Stiffness of a pair as seen from one body: (u + arm theta x n) in D, theta in bending/twist.
Matrix6 one_sided(const PairStiffness& k, const Vec3& n, double arm_m) {
  const Mat3 along = n * n.transpose();
  const Mat3 across = Mat3::Identity() - along;
  Mat3 turn;  // turn * theta = theta x n
  turn << 0, n.z(), -n.y(), -n.z(), 0, n.x(), n.y(), -n.x(), 0;
  const Mat3 d = k.normal * along + k.shear * across;
  Eigen::Matrix<double, 3, 6> b;
  b << Mat3::Identity(), arm_m * turn;
  Matrix6 stiffness = b.transpose() * d * b;
  stiffness.bottomRightCorner<3, 3>() += k.bending * across + k.twisting * along;
  return stiffness;
}

ContactMatrices contact_matrices(const Model& model, const LaneLaw& law, double factor,
                                 double effective_mass_kg, double effective_radius_m) {
  const double kn = law.contact_stiffness * factor;
  const double c = model.damping_kind == DampingKind::rate ? effective_mass_kg
                                                           : std::sqrt(effective_mass_kg * kn);
  const double ks = kn * law.shear_stiffness_ratio;
  const double rolling =
      law.rolling_friction > 0 ? ks * effective_radius_m * effective_radius_m : 0.0;
  return {.springs = {.normal = kn, .shear = ks, .bending = rolling},
          .dashpots = {.normal = c * law.normal_damping, .shear = c * law.tangential_damping}};
}

ContactMatrices pair_matrices(const Model& model, const LaneLaw& law, int i, int j) {
  const double ri = model.radius_m[as_size(i)];
  const double rj = model.radius_m[as_size(j)];
  const double mi = model.mass_kg[as_size(i)];
  const double mj = model.mass_kg[as_size(j)];
  const double r = std::min(ri, rj);
  const double factor = model.stiffness_kind == StiffnessKind::modulus
                            ? std::numbers::pi * r * r / (ri + rj)
                            : 1.0;
  return contact_matrices(model, law, factor * stiffness_bound(law.effects), mi * mj / (mi + mj), rolling_radius_m(model, i, j));
}

void add_pair(const Model& model, const State& state, std::vector<Load>& sum, int i, int j,
              const PairStiffness& k, std::size_t kind, int lane) {
  const double ri = model.radius_m[as_size(i)];
  const double rj = model.radius_m[as_size(j)];
  const Vec3 branch = state.position_m(j, lane) - state.position_m(i, lane);
  const double distance = branch.norm();
  const Vec3 n = branch / distance;
  sum[as_size(i)][kind] += 2 * one_sided(k, n, 0.5 * (distance + ri - rj));
  sum[as_size(j)][kind] += 2 * one_sided(k, n, -0.5 * (distance + rj - ri));
}

/// Walls and tools.
void add_rigid_bodies(const Model& model, const State& state,
                      const std::vector<MeshFeatures>& tool_features, std::vector<Load>& sum, int i,
                      int lane) {
  const double r = model.radius_m[as_size(i)];
  const Vec3 x = state.position_m(i, lane);
  const double factor = model.stiffness_kind == StiffnessKind::modulus ? std::numbers::pi * r : 1.0;
  const ContactMatrices k =
      contact_matrices(model, model.lanes[as_size(lane)], factor, model.mass_kg[as_size(i)], r);
  const auto add = [&](const Vec3& n, double distance) {
    sum[as_size(i)][0] += one_sided(k.springs, n, distance);
    sum[as_size(i)][1] += one_sided(k.dashpots, n, distance);
  };
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w) {
    const double distance = wall_distance_m(model, state, w, x, lane);
    if (distance > 1.02 * r) continue;
    add(wall_normal(model, state, w, x, lane), distance);
  }
  for (const WallReference& reference : model.wall_references) {
    if (!reference.glued || reference.particle != i) continue;
    const double distance = wall_distance_m(model, state, reference.wall, x, lane);
    if (distance > 1.02 * r) add(wall_normal(model, state, reference.wall, x, lane), distance);
  }
  for (int t = 0; t < static_cast<int>(model.tools.size()); ++t) {
    const MeshFeatures& mesh = tool_features[as_size(t)];
    const Vec3 in_body = to_body_frame(state, t, x, lane);
    for (std::size_t f = 0; f < mesh.features.size(); ++f)
      if (const auto d = feature_distance(mesh, f, in_body, 1.02 * r,
                                          model.tools[as_size(t)].max_depth_m))
        add(state.tool_orientation(t, lane) * d->normal, d->distance_m);
  }
}

/// Largest eigenvalue of M^-1/2 k M^-1/2 of one grain.
double largest_eigenvalue(const Matrix6& k, double mass_kg, double radius_m) {
  Eigen::Matrix<double, 6, 1> scale;
  scale << Vec3::Constant(1 / std::sqrt(mass_kg)),
      Vec3::Constant(1 / std::sqrt(0.4 * mass_kg * radius_m * radius_m));
  const Matrix6 scaled = scale.asDiagonal() * k * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix6>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[5];
}

}  // namespace

double stable_time_step_s(const Model& model, const State& state, int lane) {
  const LaneLaw& law = model.lanes[as_size(lane)];
  std::vector<Load> sum(model.radius_m.size(), Load{Matrix6::Zero(), Matrix6::Zero()});
  const double r_max =
      model.radius_m.empty() ? 0.0 : *std::ranges::max_element(model.radius_m);
  for (const ReferenceDistance& p : pairs_within(model, state, 0.04 * r_max, lane)) {
    const ContactMatrices k = pair_matrices(model, law, p.i, p.j);
    add_pair(model, state, sum, p.i, p.j, k.springs, 0, lane);
    add_pair(model, state, sum, p.i, p.j, k.dashpots, 1, lane);
  }
  for (const BondGeometry& b : model.bonds)
    add_pair(model, state, sum, b.i, b.j,
             {law.bond.normal_scale * b.normal_factor, law.bond.shear_scale * b.shear_factor,
              law.bond.bending_scale * b.bending_factor,
              law.bond.twisting_scale * b.twisting_factor},
             0, lane);
  std::vector<MeshFeatures> tool_features;
  for (const Tool& tool : model.tools) tool_features.push_back(mesh_features(tool.mesh));
  double dt_s = std::numeric_limits<double>::infinity();
  for (int i = model.num_fixed; i < model.num_particles(); ++i) {
    add_rigid_bodies(model, state, tool_features, sum, i, lane);
    const double m = model.mass_kg[as_size(i)];
    const double r = model.radius_m[as_size(i)];
    const double k = largest_eigenvalue(sum[as_size(i)][0], m, r);
    const double c = largest_eigenvalue(sum[as_size(i)][1], m, r);
    if (k > 0 || c > 0) dt_s = std::min(dt_s, 4 / (c + std::sqrt(c * c + 4 * k)));
  }
  return dt_s;
}

double ladder_time_step_s(double dt_s) {
  return std::exp2(std::floor(4 * std::log2(dt_s)) / 4);
}

}  // namespace tilth
