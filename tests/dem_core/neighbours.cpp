// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The neighbour search against all pairs, and the list against a longer list.
#include "dem_core/neighbours.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "dem_core/packing.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using tilth::testing::scattered_points;
using tilth::testing::Scene;

namespace {

using Pairs = std::vector<std::pair<int, int>>;

Pairs all_pairs_within(const Scene& scene, double gap_m, int lane = 0) {
  Pairs pairs;
  for (int i = 0; i < scene.model.num_particles(); ++i)
    for (int j = i + 1; j < scene.model.num_particles(); ++j) {
      const double reach_m = scene.model.radius_m[static_cast<std::size_t>(i)] +
                             scene.model.radius_m[static_cast<std::size_t>(j)] + gap_m;
      if ((scene.state.position_m(j, lane) - scene.state.position_m(i, lane)).norm() < reach_m)
        pairs.emplace_back(i, j);
    }
  return pairs;
}

Pairs found_within(const Scene& scene, double gap_m, int lane = 0) {
  Pairs pairs;
  for (const ReferenceDistance& p : pairs_within(scene.model, scene.state, gap_m, lane))
    pairs.emplace_back(p.i, p.j);
  return pairs;
}

Pairs listed(const Scene& scene) {
  Pairs pairs;
  for (int i = 0; i < scene.model.num_particles(); ++i)
    for (int p = scene.state.contacts.row_begin[static_cast<std::size_t>(i)];
         p < scene.state.contacts.row_begin[static_cast<std::size_t>(i) + 1]; ++p)
      pairs.emplace_back(i, scene.state.contacts.partner[static_cast<std::size_t>(p)]);
  return pairs;
}

Scene random_grains(int n, double size_m, unsigned seed) {
  Scene scene;
  std::mt19937_64 rng(seed);
  for (const Vec3& p : scattered_points(n, size_m, 0.0, seed))
    scene.sphere(p, 0.2 + 0.8 * uniform01(rng));
  return scene;
}

void place(Scene& scene, int particle, int lane, const Vec3& x) {
  const auto w = static_cast<std::size_t>(scene.state.num_lanes);
  for (std::size_t k = 0; k < 3; ++k)
    scene.state
        .motion[(static_cast<std::size_t>(particle) * 9 + k) * w + static_cast<std::size_t>(lane)] =
        x[static_cast<Eigen::Index>(k)];
}

}  // namespace

TEST_CASE("neighbours: the grid finds exactly the pairs that all pairs find",
          "[dem_core][neighbours]") {
  for (const double size_m : {4.0, 20.0, 300.0})
    for (const double gap_m : {0.0, 0.5}) {
      Scene scene = random_grains(300, size_m, 5);
      scene.begin();
      CAPTURE(size_m, gap_m);
      CHECK(found_within(scene, gap_m) == all_pairs_within(scene, gap_m));
    }
}

TEST_CASE("neighbours: grains far outside are found too", "[dem_core][neighbours]") {
  Scene scene = random_grains(300, 15, 6);
  for (const double far : {1e3, 1e9, -1e6}) {
    scene.sphere({far, 0, 0});
    scene.sphere({far + 1.5, 0.2, 0});
  }
  scene.sphere({2, 2, -4e4});
  scene.begin();
  CHECK(found_within(scene, 0.3) == all_pairs_within(scene, 0.3));
}

TEST_CASE("neighbours: grains in one point, one grain and none", "[dem_core][neighbours]") {
  Scene heap;
  for (int i = 0; i < 5; ++i) heap.sphere({1, 1, 1});
  heap.begin();
  CHECK(found_within(heap, 0).size() == 10);
  Scene one;
  one.sphere({0, 0, 0});
  one.begin();
  CHECK(found_within(one, 1).empty());
  Scene none;
  none.begin();
  CHECK(found_within(none, 1).empty());
}

TEST_CASE("neighbours: the list is the union of all active lanes and the bonds",
          "[dem_core][neighbours]") {
  Scene scene = random_grains(120, 9, 7);
  scene.bond(3, 117);
  scene.set_num_lanes(4);
  scene.begin();
  const std::vector<Vec3> elsewhere = scattered_points(120, 12, 0.0, 8);
  for (int i = 0; i < 120; ++i) {
    place(scene, i, 1, elsewhere[static_cast<std::size_t>(i)]);
    place(scene, i, 2, Vec3::Constant(std::nan("")));  // a lane that diverged and was frozen
  }
  scene.state.active[2] = 0;
  scene.workspace.skin_m = 0.3;
  rebuild_neighbours(scene.model, scene.state, scene.workspace);
  Pairs expected = all_pairs_within(scene, 0.3, 0);
  for (const auto& p : all_pairs_within(scene, 0.3, 1)) expected.push_back(p);
  expected.emplace_back(3, 117);
  std::ranges::sort(expected);
  expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
  CHECK(listed(scene) == expected);
}

TEST_CASE("neighbours: a diverged lane can be searched without harm", "[dem_core][neighbours]") {
  Scene scene = random_grains(20, 5, 9);
  scene.begin();
  place(scene, 4, 0, Vec3::Constant(std::nan("")));
  place(scene, 5, 0, Vec3::Constant(std::numeric_limits<double>::infinity()));
  CHECK(found_within(scene, 0.1) == all_pairs_within(scene, 0.1));
}

TEST_CASE("neighbours: a short list gives the bits of a long one", "[dem_core][neighbours]") {
  const auto pour = [](double skin_m, std::int64_t& num_rebuilds) {
    Scene scene;
    scene.model.skin_m = skin_m;
    scene.model.gravity_m_per_s2 = {0, 0, -10};
    scene.law().friction = 0.5;
    scene.law().wall_friction = 0.3;
    scene.law().normal_damping = 0.3;
    scene.law().dt_s = 1e-3;
    const double size_m = 8;
    for (const Vec3& p : scattered_points(40, size_m - 2, 1.6, 10))
      scene.sphere(p + Vec3::Constant(1), 0.8);
    for (int axis = 0; axis < 3; ++axis) {
      scene.plane(Vec3::Unit(axis));
      scene.plane(-Vec3::Unit(axis), Vec3::Constant(size_m));
    }
    scene.begin();
    scene.run(3000);
    num_rebuilds = scene.workspace.num_rebuilds;
    return scene.state.motion;
  };
  std::int64_t many = 0;
  std::int64_t few = 0;
  CHECK(pour(0.02, many) == pour(2.0, few));  // determinism: every bit
  CHECK(many > 10 * few);
}

TEST_CASE("neighbours: a pair is listed in time for a reference distance beyond the radii",
          "[dem_core][neighbours]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.sphere({3.2, 0, 0});
  scene.model.references.push_back({0, 1, 3.0});
  scene.begin();
  scene.state.set_velocity_m_per_s(1, {-10, 0, 0});
  // the closest approach of an elastic impact is v sqrt(m_eff / k) = 0.07 m within the reference
  for (int n = 0; n < 1000; ++n) {
    scene.run(1);
    REQUIRE((scene.state.position_m(1) - scene.state.position_m(0)).norm() > 2.92);
  }
  CHECK(scene.state.velocity_m_per_s(0).x() < -9.9);
}
