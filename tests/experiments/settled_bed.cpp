// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Loose grains that come to rest under gravity.
#include "experiments/settled_bed.hpp"

#include "dem_core/neighbours.hpp"
#include "dem_core/time_step.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinRel;

namespace {

constexpr double depth_m = 0.08;

/// 200 grains in a box on a plane; with `num_fixed`, the first of them hang in the air for good.
LaneRun bed(double friction, int num_fixed) {
  SoilMaterial grains;
  grains.friction = friction;
  const Packing packing = *packings().get({.shape = ContainerShape::box,
                                           .size_m = Vec3(0.03, 0.03, depth_m),
                                           .num_particles = 200,
                                           .porosity = 0.45});
  std::vector<Wall> walls = {{.direction = Vec3::UnitZ()}};
  for (int axis = 0; axis < 2; ++axis) {
    walls.push_back({.direction = Vec3::Unit(axis)});
    walls.push_back({.direction = -Vec3::Unit(axis), .position_m = Vec3::Constant(0.03)});
  }
  return LaneRun(make_loose_bed(packing, std::vector<SoilMaterial>{grains}, walls,
                                {.depth_m = depth_m, .num_fixed = num_fixed}));
}

void settle(LaneRun& run) {
  CalmWatch watch(1e-6, 20);
  run_protocol(run, 100, 400'000, {}, [&](LaneRun& r, int lane) {
    if (watch.calm(agitation(r, lane))) r.finish(lane, RunStatus::completed, "calm");
  });
  INFO(run.results[0].message);
  REQUIRE(run.results[0].status == RunStatus::completed);
}

}  // namespace

TEST_CASE("Settled bed: the floor carries the weight, overlaps are small, the step is stable",
          "[experiments][settled_bed]") {
  for (const double friction : {0.0, 0.6}) {
    LaneRun run = bed(friction, 0);
    settle(run);
    const Model& model = run.specimen.model;
    double weight_N = 0;
    for (const double m : model.mass_kg) weight_N += 9.81 * m;
    // 1 %: a bed with 1e-6 m g r per grain still rocks; walls are greased and carry nothing
    CHECK_THAT(-run.wall_force_N(0, 0).z(), WithinRel(weight_N, 0.01));
    double largest = 0, sum = 0;
    int num_contacts = 0;
    for (const ReferenceDistance& p : pairs_within(model, run.specimen.state, 0.0)) {
      const double ri = model.radius_m[static_cast<std::size_t>(p.i)];
      const double rj = model.radius_m[static_cast<std::size_t>(p.j)];
      const double overlap = (ri + rj - p.distance_m) / std::min(ri, rj);
      largest = std::max(largest, overlap);
      sum += overlap;
      ++num_contacts;
    }
    // 2.5 (1 - porosity) / 700 = 0.2 % at the bottom, half of it on average; forces spread exponentially,
    // and a small grain between large ones takes their force: ten times the mean
    CHECK(sum / num_contacts < 0.003);
    CHECK(sum / num_contacts > 0.0005);
    CHECK(largest < 0.02);
    // the bound made before anything touched holds for what came out of it
    CHECK(run.dt_s(0) < stable_time_step_s(model, run.specimen.state));
    CHECK(bed_height_m(run, 0) < 1.1 * depth_m);  // a box four grains wide packs loosely
    CHECK(bed_height_m(run, 0) > 0.7 * depth_m);
  }
}

TEST_CASE("Settled bed: fixed grains stay where they are and do not count as agitated",
          "[experiments][settled_bed]") {
  LaneRun run = bed(0.3, 5);
  std::vector<Vec3> before;
  for (int i = 0; i < 6; ++i) before.push_back(run.specimen.state.position_m(i));
  settle(run);
  for (int i = 0; i < 5; ++i)
    CHECK(run.specimen.state.position_m(i) == before[static_cast<std::size_t>(i)]);
  CHECK(run.specimen.state.position_m(5) != before[5]);
}

TEST_CASE("Settled bed: calm means below the limit for a number of intervals in a row",
          "[experiments][settled_bed]") {
  CalmWatch watch(1.0, 3);
  for (const double a : {0.5, 0.5, 2.0, 0.5, 0.5}) CHECK_FALSE(watch.calm(a));
  CHECK(watch.calm(0.5));
  watch.begin_again();
  CHECK_FALSE(watch.calm(0.5));
  CHECK_FALSE(watch.calm(std::nan("")));
}
