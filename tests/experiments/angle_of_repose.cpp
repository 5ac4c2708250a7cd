// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The heap's surface, what its slope depends on and what it does not.
#include "experiments/angle_of_repose.hpp"

#include <cmath>
#include <numbers>

#include "experiments/heap_profile.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// A soft, fast heap: its grains are pressed by up to 4 % of a radius.
AngleOfReposeConfig small_heap() {
  return {.num_particles = 300, .stiffness_over_weight = 200, .wall_speed_over_fall_speed = 0.6};
}

SoilMaterial grains(double friction, double rolling_friction) {
  SoilMaterial m;
  m.friction = friction;
  m.rolling_friction = rolling_friction;
  return m;
}

std::vector<ExperimentResult> heaps(const std::vector<SoilMaterial>& soils,
                                    const AngleOfReposeConfig& config) {
  const std::vector<ExperimentResult> results = run_angle_of_repose(soils, config, packings());
  for (const ExperimentResult& r : results) {
    INFO(r.message);
    REQUIRE(r.status == RunStatus::completed);
  }
  return results;
}

double angle_rad(const AngleOfReposeConfig& config) {
  return heaps({grains(0.5, 0)}, config).front().feature("repose_angle_rad");
}

}  // namespace

TEST_CASE("Angle of repose: the line through a wedge of grains has the wedge's slope and ends",
          "[experiments][repose]") {
  // Grains of 1 m diameter, one per cell, tops on 20 m - x tan(30 deg); one fixed grain far above.
  Specimen wedge;
  const double slope = std::tan(30 * degree);
  std::vector<Vec3> centre_m = {{3.5, 0.5, 90}};
  for (double x = 0.5; 20 - x * slope > 0.5; x += 1)
    for (const double y : {0.5, 1.5}) centre_m.emplace_back(x, y, 20 - x * slope - 0.5);
  wedge.model.radius_m.assign(centre_m.size(), 0.5);
  wedge.model.num_fixed = 1;
  wedge.model.lanes.resize(1);
  wedge.state = initial_state(wedge.model, centre_m);
  const HeapFrame frame{.length_m = 50, .thickness_m = 2, .cell_m = 1};
  const std::vector<double> profile_m = heap_profile_m(wedge, 0, frame);
  REQUIRE(profile_m.size() == 50);
  const HeapShape heap = heap_shape(profile_m, 1);
  CHECK_THAT(heap.angle_rad, WithinAbs(30 * degree, 1e-12));
  CHECK_THAT(heap.height_m, WithinAbs(20 - slope, 1e-12));
  // it falls below 3/4 m between x = 33 and 34
  CHECK(heap.runout_m == 33);
  CHECK(heap.num_points == 23);
  CHECK(heap_shape({2, 1, 0}, 1).num_points < 3);
}

TEST_CASE("Angle of repose: it grows with sliding friction and, beyond that, with rolling friction",
          "[experiments][repose]") {
  const auto results = heaps({grains(0, 0), grains(0.5, 0), grains(0.5, 0.4)}, small_heap());
  std::vector<double> angle_deg;
  for (const ExperimentResult& r : results)
    angle_deg.push_back(r.feature("repose_angle_rad") / degree);
  CAPTURE(angle_deg);
  // Frictionless beads in bulk hold 5.8 degrees (Peyneau & Roux, Phys. Rev. E 78 (2008) 011307); 6
  // degrees more: a slab three grains thick that stands on fixed grains.
  CHECK(angle_deg[0] < 5.8 + 6);
  CHECK(angle_deg[0] > 0);
  // 3 degrees: the scatter of single heaps
  CHECK(angle_deg[1] > angle_deg[0] + 3);
  CHECK(angle_deg[2] > angle_deg[1] + 3);
  for (const ExperimentResult& r : results) {
    const Curve& history = r.curves[0];
    const std::size_t wall = column_of(history, "wall_position_m");
    CHECK(r.feature("runout_m") < history.rows.back()[wall]);  // it stands clear of its wall
    CHECK(history.rows.back()[column_of(history, "agitation")] < 1e-5);
  }
}

TEST_CASE("Angle of repose: similar heaps are the same heap", "[experiments][repose]") {
  // Lengths x 16 and gravity x 4 stretch time by 2 and everything else by powers of two: not one bit of
  // a ratio changes.
  AngleOfReposeConfig config = small_heap();
  config.num_particles = 60;
  const double here_rad = angle_rad(config);
  config.column_length_m *= 16;
  config.column_height_m *= 16;
  config.slab_thickness_m *= 16;
  config.gravity_m_per_s2 *= 4;
  CHECK(angle_rad(config) == here_rad);
}

TEST_CASE("Angle of repose: packs of 4 and 8 give every member the bits of its own run",
          "[experiments][repose][packs]") {
  AngleOfReposeConfig config = small_heap();
  config.num_particles = 50;
  config.floor_over_column_length = 3;
  config.wall_speed_over_fall_speed = 1.0;
  config.agitation_limit = 1e-3;
  const std::vector<SoilMaterial> soils = {grains(0.2, 0), grains(0.5, 0.2), grains(0.8, 0),
                                           grains(0.3, 0.1), grains(1.0, 0)};
  const auto single = run_angle_of_repose(soils, config, packings(), with_lanes(1));
  for (const ExperimentResult& r : single) REQUIRE(r.status == RunStatus::completed);
  for (const int lanes : {4, 8}) {
    INFO(lanes << " lanes");
    require_same(run_angle_of_repose(soils, config, packings(), with_lanes(lanes)), single);
  }
}

TEST_CASE("Angle of repose: a heap that does not come to rest is not a number",
          "[experiments][repose]") {
  AngleOfReposeConfig config = small_heap();
  config.num_particles = 150;
  config.agitation_limit = 1e-12;
  config.restitution = 1;  // with no friction either: nothing takes energy
  const ExperimentResult r =
      run_angle_of_repose(std::vector<SoilMaterial>{grains(0, 0)}, config, packings()).front();
  CHECK(r.status == RunStatus::not_settled);
  CHECK_THAT(r.message, Contains("m g r after"));
  CHECK(r.features.empty());
}
