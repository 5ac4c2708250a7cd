// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The automatic time step against the exact stability limit of the assembled system
// (docs/theory/time_step.md). The assembly here is written independently of the library's.
#include "dem_core/time_step.hpp"

#include <Eigen/Dense>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "dem_core/packing.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinRel;
using tilth::testing::add_bonded_cluster;
using tilth::testing::Scene;

namespace {

/// Stiffness and dashpots of a whole assembly, scaled with the masses: M^-1/2 K M^-1/2.
struct Assembly {
  Eigen::MatrixXd stiffness_per_s2, damping_per_s;

  explicit Assembly(int num_grains)
      : stiffness_per_s2(Eigen::MatrixXd::Zero(6 * num_grains, 6 * num_grains)),
        damping_per_s(stiffness_per_s2) {}

  /// Adds weight x row^T row for a relative displacement row . (u, theta).
  static void add(Eigen::MatrixXd& m, double weight, const Eigen::RowVectorXd& row) {
    m += weight * row.transpose() * row;
  }

  /// Largest dt with 4 - 2 dt C - dt^2 K >= 0 on every motion, by bisection.
  double exact_limit_s() const {
    double low = 0, high = 1e3;
    for (int k = 0; k < 100; ++k) {
      const double dt = 0.5 * (low + high);
      const Eigen::MatrixXd m = 2 * dt * damping_per_s + dt * dt * stiffness_per_s2;
      const double largest =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly)
              .eigenvalues()
              .maxCoeff();
      (largest < 4 ? low : high) = dt;
    }
    return low;
  }
};

/// Three directions: the normal and two tangents.
std::array<Vec3, 3> frame(const Vec3& n) {
  const Vec3 t = n.unitOrthogonal();
  return {n, t, n.cross(t)};
}

/// One joint between body i (arm towards the contact) and j (or a wall, j < 0).
struct Joint {
  int i = 0, j = -1;
  Vec3 normal;  ///< from i to j
  double arm_i_m = 0, arm_j_m = 0;
  double kn = 0, ks = 0, kb = 0, kt = 0, cn = 0, ct = 0;
};

void add_joint(Assembly& a, const Model& model, const Joint& joint) {
  const auto fill = [&](Eigen::RowVectorXd& row, int body, const Vec3& translation,
                        const Vec3& rotation) {
    if (body < 0) return;
    const double m = model.mass_kg[static_cast<std::size_t>(body)];
    const double r = model.radius_m[static_cast<std::size_t>(body)];
    row.segment<3>(6 * body) += translation.transpose() / std::sqrt(m);
    row.segment<3>(6 * body + 3) += rotation.transpose() / std::sqrt(0.4 * m * r * r);
  };
  const auto axes = frame(joint.normal);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& d = axes[k];
    // contact point of i: u + theta x (arm n); of j: u - theta x (arm n)
    Eigen::RowVectorXd slide = Eigen::RowVectorXd::Zero(a.stiffness_per_s2.cols());
    fill(slide, joint.j, d, (-joint.arm_j_m * joint.normal).cross(d));
    fill(slide, joint.i, -d, -(joint.arm_i_m * joint.normal).cross(d));
    Eigen::RowVectorXd turn = Eigen::RowVectorXd::Zero(a.stiffness_per_s2.cols());
    fill(turn, joint.j, Vec3::Zero(), d);
    fill(turn, joint.i, Vec3::Zero(), -d);
    Assembly::add(a.stiffness_per_s2, k == 0 ? joint.kn : joint.ks, slide);
    Assembly::add(a.stiffness_per_s2, k == 0 ? joint.kt : joint.kb, turn);
    Assembly::add(a.damping_per_s, k == 0 ? joint.cn : joint.ct, slide);
  }
}

double contact_dashpot(const Model& model, double number, double mass_kg, double kn) {
  return model.damping_kind == DampingKind::rate ? number * mass_kg
                                                 : number * std::sqrt(mass_kg * kn);
}

/// Touching contacts (stiffness per contact), bonds, and planes or cylinders.
Assembly assemble(const Scene& scene) {
  const Model& model = scene.model;
  const LaneLaw& law = model.lanes[0];
  const int n = model.num_particles();
  Assembly a(n);
  const auto r = [&](int i) { return model.radius_m[static_cast<std::size_t>(i)]; };
  const auto m = [&](int i) { return model.mass_kg[static_cast<std::size_t>(i)]; };
  const double kn = law.contact_stiffness;
  const double ks = kn * law.shear_stiffness_ratio;
  const auto joint_of = [&](int i, int j) {
    const Vec3 branch = scene.state.position_m(j) - scene.state.position_m(i);
    const double d = branch.norm();
    return Joint{.i = i,
                 .j = j,
                 .normal = branch / d,
                 .arm_i_m = 0.5 * (d + r(i) - r(j)),
                 .arm_j_m = 0.5 * (d + r(j) - r(i))};
  };
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) {
      if ((scene.state.position_m(j) - scene.state.position_m(i)).norm() >= r(i) + r(j)) continue;
      Joint joint = joint_of(i, j);
      const double mass_kg = m(i) * m(j) / (m(i) + m(j));
      joint.kn = kn;
      joint.ks = ks;
      joint.cn = contact_dashpot(model, law.normal_damping, mass_kg, kn);
      joint.ct = contact_dashpot(model, law.tangential_damping, mass_kg, kn);
      add_joint(a, model, joint);
    }
  for (const BondGeometry& b : model.bonds) {
    Joint joint = joint_of(b.i, b.j);
    joint.kn = law.bond.normal_scale * b.normal_factor;
    joint.ks = law.bond.shear_scale * b.shear_factor;
    joint.kb = law.bond.bending_scale * b.bending_factor;
    joint.kt = law.bond.twisting_scale * b.twisting_factor;
    add_joint(a, model, joint);
  }
  for (const Wall& w : model.walls)
    for (int i = 0; i < n; ++i) {
      const Vec3 offset = scene.state.position_m(i) - w.position_m;
      const Vec3 radial = offset - offset.dot(w.direction) * w.direction;
      const bool plane = w.shape == WallShape::plane;
      const double distance_m = plane ? offset.dot(w.direction) : w.radius_m - radial.norm();
      if (distance_m >= r(i)) continue;
      Joint joint{.i = i,
                  .normal = plane ? Vec3(-w.direction) : Vec3(radial.normalized()),
                  .arm_i_m = distance_m,
                  .kn = kn,
                  .ks = ks};
      joint.cn = contact_dashpot(model, law.normal_damping, m(i), kn);
      joint.ct = contact_dashpot(model, law.tangential_damping, m(i), kn);
      add_joint(a, model, joint);
    }
  return a;
}

/// A cluster with bonds, contacts, a floor and a tube around it.
Scene random_assembly(unsigned seed) {
  Scene scene;
  scene.law().shear_stiffness_ratio = 0.3 + 0.1 * seed;
  scene.law().bond = {.normal_scale = 5e3 * (1 + seed % 3),
                      .shear_scale = 3e3,
                      .bending_scale = 2e3,
                      .twisting_scale = 1e3,
                      .tensile_limit = 1e9,
                      .cohesion_limit = 1e9};
  add_bonded_cluster(scene, {0, 0, 2.5}, 12, 2.2, seed);
  double low_m = 1e9, wide_m = 0;
  for (int i = 0; i < 12; ++i) {
    const Vec3& x = scene.start_m[static_cast<std::size_t>(i)];
    const double r = scene.model.radius_m[static_cast<std::size_t>(i)];
    low_m = std::min(low_m, x.z() - r);
    wide_m = std::max(wide_m, x.head<2>().norm() + r);
  }
  scene.plane(Vec3::UnitZ(), {0, 0, low_m + 0.4});
  Wall tube;
  tube.shape = WallShape::cylinder;
  tube.radius_m = wide_m - 0.3;
  scene.model.walls.push_back(tube);
  scene.begin();
  return scene;
}

}  // namespace

TEST_CASE("time step: a chain of spheres has omega = 2 sqrt(k / m)", "[dem_core][time_step]") {
  Scene scene;
  for (int i = 0; i < 20; ++i) scene.sphere({3.0 * i, 0, 0});
  for (int i = 0; i < 19; ++i) scene.bond(i, i + 1);
  scene.law().bond = {.normal_scale = 400, .tensile_limit = 1e9, .cohesion_limit = 1e9};
  scene.begin();
  // dt = 2 / omega = sqrt(m / k); the library's bound is exact for the endless chain
  CHECK_THAT(stable_time_step_s(scene.model, scene.state), WithinRel(0.05, 1e-12));
  // the free chain of N: omega = 2 sqrt(k / m) cos(pi / 2N)
  CHECK_THAT(assemble(scene).exact_limit_s(),
             WithinRel(0.05 / std::cos(std::numbers::pi / 40), 1e-9));
}

TEST_CASE("time step: the bound is never above the exact limit, and above half of it",
          "[dem_core][time_step]") {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Scene scene = random_assembly(seed);
    const double ratio =
        stable_time_step_s(scene.model, scene.state) / assemble(scene).exact_limit_s();
    CAPTURE(seed, ratio);
    CHECK(ratio <= 1 + 1e-9);
    CHECK(ratio > 0.5);
  }
}

TEST_CASE("time step: the bound holds with dashpots of both kinds", "[dem_core][time_step]") {
  for (const DampingKind kind : {DampingKind::restitution, DampingKind::rate})
    for (const double strength : {0.1, 1.0, 3.0})
      for (const double tangential : {0.0, 0.5}) {
        Scene scene = random_assembly(2);
        scene.model.damping_kind = kind;
        const double unit =
            kind == DampingKind::rate ? 100.0 : 1.0;  // sqrt(k / m) = 100 per second
        scene.law().normal_damping = strength * unit;
        scene.law().tangential_damping = tangential * strength * unit;
        const double ratio =
            stable_time_step_s(scene.model, scene.state) / assemble(scene).exact_limit_s();
        CAPTURE(kind == DampingKind::rate, strength, tangential, ratio);
        CHECK(ratio <= 1 + 1e-9);
        CHECK(ratio > 0.4);
      }
}

TEST_CASE("time step: one damped sphere on a plane has the oscillator's exact limit",
          "[dem_core][time_step]") {
  Scene scene;
  scene.sphere({0, 0, 0.999});
  scene.plane(Vec3::UnitZ());
  scene.law().shear_stiffness_ratio = 0.01;
  scene.law().normal_damping = 1.2;  // zeta = 0.6
  scene.begin();
  // omega dt = 2 (sqrt(1 + zeta^2) - zeta)
  CHECK_THAT(stable_time_step_s(scene.model, scene.state),
             WithinRel(2.0 / 100 * (std::sqrt(1.36) - 0.6), 1e-12));
}

TEST_CASE("time step: grains wedged across a tube count the tube's true normal",
          "[dem_core][time_step]") {
  Scene scene;
  scene.sphere({-0.999, 0, 0});
  scene.sphere({0.999, 0, 0});
  Wall tube;
  tube.shape = WallShape::cylinder;
  tube.radius_m = 1.997;
  scene.model.walls.push_back(tube);
  scene.law().shear_stiffness_ratio = 0.1;
  scene.begin();
  // against each other: m omega^2 = k (tube) + 2 k (the other grain)
  CHECK_THAT(assemble(scene).exact_limit_s(), WithinRel(2 / std::sqrt(3e4), 1e-9));
  CHECK_THAT(stable_time_step_s(scene.model, scene.state), WithinRel(2 / std::sqrt(3e4), 1e-9));
}

TEST_CASE("time step: at 0.9 of the bound the energy stays, above the limit it grows",
          "[dem_core][time_step]") {
  const auto growth = [](double share_of_exact, double share_of_bound) {
    Scene scene;
    scene.law().bond = {.normal_scale = 1e4,
                        .shear_scale = 5e3,
                        .bending_scale = 2e3,
                        .twisting_scale = 1e3,
                        .tensile_limit = 1e30,
                        .cohesion_limit = 1e30};
    scene.law().contact_stiffness = 0;  // bonds alone: the system stays linear
    add_bonded_cluster(scene, {0, 0, 0}, 12, 2.6, 3);
    scene.begin();
    scene.law().dt_s = share_of_exact > 0
                           ? share_of_exact * assemble(scene).exact_limit_s()
                           : share_of_bound * stable_time_step_s(scene.model, scene.state);
    std::mt19937_64 rng(4);
    for (int i = 0; i < 12; ++i)
      scene.state.set_velocity_m_per_s(i,
                                       1e-5 * Vec3(uniform01(rng), uniform01(rng), uniform01(rng)));
    scene.run(1);
    const double start_J = scene.energy_now().total_J();
    double most_J = 0;
    for (int n = 0; n < 20000 && most_J < 1e6 * start_J; ++n) {
      scene.run(1);
      most_J = std::max(most_J, scene.energy_now().total_J());
    }
    return most_J / start_J;
  };
  // below the limit semi-implicit Euler keeps a nearby energy; near it the two differ by the factor
  // 1 / (1 - (omega dt / 2)), here at most 1 / (1 - 0.9) = 10
  CHECK(growth(0, 0.9) < 10);
  CHECK(growth(1.02, 0) > 1e5);
}

TEST_CASE("time step: nothing touching means no limit", "[dem_core][time_step]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.sphere({5, 0, 0});
  scene.begin();
  CHECK(stable_time_step_s(scene.model, scene.state) == std::numeric_limits<double>::infinity());
}

TEST_CASE("time step: the ladder has four rungs per doubling and never rounds up",
          "[dem_core][time_step]") {
  CHECK(ladder_time_step_s(1.0) == 1.0);
  CHECK(ladder_time_step_s(0.25) == 0.25);
  CHECK_THAT(ladder_time_step_s(0.99), WithinRel(std::exp2(-0.25), 1e-15));
  for (double dt_s = 1e-9; dt_s < 10; dt_s *= 1.013) {
    const double rung_s = ladder_time_step_s(dt_s);
    CHECK(rung_s <= dt_s);
    CHECK(rung_s > dt_s * std::exp2(-0.25) * (1 - 1e-12));
    CHECK(ladder_time_step_s(rung_s * (1 + 1e-12)) == rung_s);
  }
}
