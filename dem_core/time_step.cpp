// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/time_step.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem_core/neighbours.hpp"
#include "dem_core/wall_geometry.hpp"

namespace tilth {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Mat3 = Eigen::Matrix3d;

std::size_t as_size(int k) { return static_cast<std::size_t>(k); }

struct PairStiffness {
  double normal = 0.0, shear = 0.0, bending = 0.0, twisting = 0.0;
};

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

PairStiffness contact_stiffness(const Model& model, const LaneLaw& law, double ri, double rj) {
  const double r = std::min(ri, rj);
  const double factor = model.stiffness_kind == StiffnessKind::modulus
                            ? std::numbers::pi * r * r / (ri + rj)
                            : 1.0;
  const double kn = law.contact_stiffness * factor;
  return {.normal = kn, .shear = kn * law.shear_stiffness_ratio};
}

void add_pair(const State& state, std::vector<Matrix6>& sum, int i, int j, double ri, double rj,
              const PairStiffness& k, int lane) {
  const Vec3 branch = state.position_m(j, lane) - state.position_m(i, lane);
  const double distance = branch.norm();
  const Vec3 n = branch / distance;
  sum[as_size(i)] += 2 * one_sided(k, n, 0.5 * (distance + ri - rj));
  sum[as_size(j)] += 2 * one_sided(k, n, -0.5 * (distance + rj - ri));
}

}  // namespace

double stable_time_step_s(const Model& model, const State& state, int lane) {
  const LaneLaw& law = model.lanes[as_size(lane)];
  std::vector<Matrix6> sum(model.radius_m.size(), Matrix6::Zero());
  const double r_max =
      model.radius_m.empty() ? 0.0 : *std::ranges::max_element(model.radius_m);
  for (const ReferenceDistance& p : pairs_within(model, state, 0.04 * r_max, lane)) {
    const double ri = model.radius_m[as_size(p.i)];
    const double rj = model.radius_m[as_size(p.j)];
    add_pair(state, sum, p.i, p.j, ri, rj, contact_stiffness(model, law, ri, rj), lane);
  }
  for (const BondGeometry& b : model.bonds)
    add_pair(state, sum, b.i, b.j, model.radius_m[as_size(b.i)], model.radius_m[as_size(b.j)],
             {law.bond.normal_scale * b.normal_factor, law.bond.shear_scale * b.shear_factor,
              law.bond.bending_scale * b.bending_factor,
              law.bond.twisting_scale * b.twisting_factor},
             lane);
  double omega2 = 0.0;
  for (int i = 0; i < model.num_particles(); ++i) {
    const double r = model.radius_m[as_size(i)];
    for (int w = 0; w < static_cast<int>(model.walls.size()); ++w) {
      if (wall_distance_m(model, state, w, state.position_m(i, lane), lane) > 1.02 * r) continue;
      const double factor =
          model.stiffness_kind == StiffnessKind::modulus ? std::numbers::pi * r : 1.0;
      const double kn = law.contact_stiffness * factor;
      sum[as_size(i)] += one_sided({.normal = kn, .shear = kn * law.shear_stiffness_ratio},
                                   model.walls[as_size(w)].direction, r);
    }
    const double m = model.mass_kg[as_size(i)];
    Eigen::Matrix<double, 6, 1> scale;
    scale << Vec3::Constant(1 / std::sqrt(m)), Vec3::Constant(1 / std::sqrt(0.4 * m * r * r));
    const Matrix6 k = scale.asDiagonal() * sum[as_size(i)] * scale.asDiagonal();
    omega2 = std::max(omega2, Eigen::SelfAdjointEigenSolver<Matrix6>(k, Eigen::EigenvaluesOnly)
                                  .eigenvalues()[5]);
  }
  if (omega2 <= 0) return std::numeric_limits<double>::infinity();
  const double zeta =
      model.damping_kind == DampingKind::restitution ? 0.5 * law.normal_damping : 0.0;
  return 2 / std::sqrt(omega2) * (std::sqrt(1 + zeta * zeta) - zeta);
}

double ladder_time_step_s(double dt_s) {
  return std::exp2(std::floor(4 * std::log2(dt_s)) / 4);
}

}  // namespace tilth
