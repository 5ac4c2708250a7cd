// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// A step on several threads has the bits of one thread.
#include "dem_core/step_blocks.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <thread>

#include "dem_core/packing.hpp"
#include "experiments/tool_shapes.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using tilth::testing::Scene;

namespace {

/// Threads of the operating system, started for every call.
void on_threads(std::size_t n, const std::function<void(std::size_t)>& body) {
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < n; ++k) threads.emplace_back([&body, k] { body(k); });
  for (std::thread& t : threads) t.join();
}

/// One after the other, the last first.
void backwards(std::size_t n, const std::function<void(std::size_t)>& body) {
  for (std::size_t k = n; k-- > 0;) body(k);
}

/// 1100 overlapping grains in a shuffled order, so that neighbours lie in different blocks, half of the close pairs
/// bonded weakly enough to break; a plate below, a plate that comes down, and a box that is pushed through.
Scene crowd(int num_lanes, bool with_effects, bool with_rolling) {
  Scene scene;
  const std::vector<Vec3> points = testing::scattered_points(1100, 16.0, 1.15, 7);
  for (const Vec3& p : points) scene.sphere(p, 0.7, 1.0 + 0.1 * p.x());
  for (int i = 0; i < scene.model.num_particles(); ++i)
    for (int j = i + 1; j < scene.model.num_particles(); ++j)
      if ((i + j) % 2 == 0 && (points[static_cast<std::size_t>(i)] - points[static_cast<std::size_t>(j)]).norm() < 1.4)
        scene.bond(i, j);
  scene.plane(Vec3::UnitZ(), {0, 0, -0.5});
  scene.plane(-Vec3::UnitZ(), {0, 0, 16.5});
  scene.model.gravity_m_per_s2 = {0.3, 0.1, -1.0};
  LaneLaw& law = scene.law();
  law.friction = 0.4;
  law.wall_friction = 0.2;
  law.normal_damping = 0.2;
  law.local_damping = 0.1;
  law.rolling_friction = with_rolling ? 0.2 : 0.0;
  law.bond.normal_scale = 1000;
  law.bond.shear_scale = 500;
  law.bond.bending_scale = law.bond.twisting_scale = 100;
  law.bond.tensile_limit = 20;
  law.bond.cohesion_limit = 10;
  if (with_effects) {
    law.effects.contact_plasticity = 0.4;
    law.effects.capillary_Pa = 20;
    law.effects.bond_softening = 1.0;
  }
  scene.set_num_lanes(num_lanes);
  for (int lane = 0; lane < num_lanes; ++lane) scene.law(lane).contact_stiffness *= 1 + 0.1 * lane;
  scene.begin();
  const std::vector<Vec3> stir = testing::scattered_points(1100, 16.0, 0.0, 11);
  for (int i = 0; i < scene.model.num_particles(); ++i)
    scene.state.set_velocity_m_per_s(i, 0.4 * (stir[static_cast<std::size_t>(i)] - Vec3::Constant(8.0)));
  for (int lane = 0; lane < num_lanes; ++lane) scene.state.drive(1, lane).velocity_m_per_s = {0, 0, -0.5};
  return scene;
}

void check_same_bits(const Scene& a, const Scene& b) {
  CHECK(a.state.motion == b.state.motion);
  CHECK(a.state.bonds == b.state.bonds);
  CHECK(a.state.contacts.spring_m == b.state.contacts.spring_m);
  CHECK(a.state.contacts.rolling_rad == b.state.contacts.rolling_rad);
  CHECK(a.state.contacts.effects == b.state.contacts.effects);
  CHECK(a.state.wall_force == b.state.wall_force);
  CHECK(a.workspace.num_broken == b.workspace.num_broken);
  CHECK(a.workspace.max_speed2_m2_per_s2 == b.workspace.max_speed2_m2_per_s2);
}

}  // namespace

TEST_CASE("Step on several threads: every bit of one thread", "[dem_core][threads]") {
  struct Kind {
    bool effects, rolling;
  };
  for (const Kind kind : {Kind{false, false}, Kind{false, true}, Kind{true, true}})
    for (const int num_lanes : {1, 4, 8}) {
      if (!lanes_supported(num_lanes)) continue;
      CAPTURE(kind.effects, kind.rolling, num_lanes);
      Scene alone = crowd(num_lanes, kind.effects, kind.rolling);
      alone.run(150);
      CAPTURE(alone.workspace.num_broken[0], alone.workspace.num_rebuilds);
      REQUIRE(alone.workspace.num_broken[0] > 10);
      REQUIRE(alone.workspace.num_rebuilds > 1);
      for (const int num_threads : {2, 3, 4}) {
        CAPTURE(num_threads);
        Scene team = crowd(num_lanes, kind.effects, kind.rolling);
        team.workspace.num_threads = num_threads;
        team.workspace.side_by_side = num_threads == 3 ? SideBySide(backwards) : SideBySide(on_threads);
        team.run(150);
        REQUIRE(team.workspace.blocks.size() == static_cast<std::size_t>(num_threads));
        REQUIRE(team.workspace.cross_pair.size() > 100);
        check_same_bits(alone, team);
      }
    }
}

TEST_CASE("Step on several threads: blocks hold every pair once, a small model has none", "[dem_core][threads]") {
  Scene scene = crowd(1, false, false);
  scene.workspace.num_threads = 4;
  scene.workspace.side_by_side = backwards;
  scene.run(1);
  const Workspace& w = scene.workspace;
  const std::vector<std::int32_t>& row_begin = scene.state.contacts.row_begin;
  std::size_t inside = 0, in = 0;
  for (const StepBlock& block : w.blocks) {
    in += block.cross_in.size();
    for (auto i = static_cast<std::size_t>(block.row_from); i < static_cast<std::size_t>(block.row_to); ++i) {
      inside += static_cast<std::size_t>(w.row_end[i] - row_begin[i]);
      for (std::int32_t p = row_begin[i]; p < w.row_end[i]; ++p)
        CHECK(w.pairs[static_cast<std::size_t>(p)].j < block.row_to);
    }
  }
  CHECK(inside + w.cross_pair.size() == w.pairs.size());
  CHECK(in == w.cross_pair.size());
  CHECK(w.blocks.front().row_from == 0);
  CHECK(w.blocks.back().row_to == scene.model.num_particles());

  Scene small;
  small.sphere({0, 0, 0});
  small.workspace.num_threads = 4;
  small.workspace.side_by_side = backwards;
  small.begin();
  small.run(1);
  CHECK(small.workspace.blocks.empty());
}
