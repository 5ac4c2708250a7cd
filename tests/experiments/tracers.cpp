// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Tracers and surface profiles on beds that can be counted by hand.
#include "experiments/tracers.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "experiments/surface_profile.hpp"

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Centres on a square lattice, 10 mm apart.
std::vector<Vec3> lattice(int nx, int ny, int nz) {
  std::vector<Vec3> x;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) x.emplace_back(0.01 * i, 0.01 * (j - ny / 2), 0.01 * k);
  return x;
}

}  // namespace

TEST_CASE("tracers: small cubes follow the nearest aggregate, large ones the mean of those inside",
          "[experiments][tracers]") {
  const std::vector<Vec3> before = lattice(11, 5, 4);
  TracerGrid grid{
      .depth_m = {0.011, 0.02}, .lateral_m = {-0.01, 0.0}, .spacing_m = 0.02, .size_m = 0.005};
  const auto small = place_tracers(grid, 0.02, 0.06, 0.03, before);
  REQUIRE(small.size() == 2 * 2 * 3);
  CHECK(small.front().site_m == Vec3(0.02, -0.01, 0.03 - 0.011));
  REQUIRE(small.front().particles.size() == 1);
  CHECK((before[static_cast<std::size_t>(small.front().particles[0])] - Vec3(0.02, -0.01, 0.02))
            .norm() < 1e-12);
  grid.size_m = 0.0201;
  const auto large = place_tracers(grid, 0.02, 0.06, 0.03, before);
  CHECK(large.back().particles.size() == 27);  // depth 0.02 is on the lattice: 3 x 3 x 3
  // a shear forward = 2 z: the mean over the cube is that of its middle
  std::vector<Vec3> after = before;
  for (Vec3& x : after) x.x() += 2 * x.z();
  const Vec3 moved = tracer_displacement_m(large.back(), before, after);
  CHECK_THAT(moved.x(), WithinRel(2 * large.back().site_m.z(), 1e-12));
  CHECK(moved.y() == 0);
}

TEST_CASE("tracers: means and scatter of a row are those of its numbers",
          "[experiments][tracers]") {
  std::vector<Tracer> tracers(5);
  tracers[3].lateral_m = tracers[4].lateral_m = 0.1;
  const std::vector<Vec3> moved = {{1, 0, 0}, {2, 0, 0}, {6, 0, 3}, {5, 1, 0}, {7, 1, 0}};
  const auto means = tracer_means(tracers, moved);
  REQUIRE(means.size() == 2);
  CHECK(means[0].num_tracers == 3);
  CHECK(means[0].mean_m == Vec3(3, 0, 1));
  CHECK_THAT(means[0].sd_m.x(), WithinRel(std::sqrt(7.0), 1e-12));  // (4 + 1 + 9) / 2
  CHECK_THAT(means[1].sd_m.x(), WithinRel(std::sqrt(2.0), 1e-12));
  CHECK(means[1].sd_m.y() == 0);
  CHECK(tracer_label(0.05, -0.1) == "0.05m_-0.1m");
}

TEST_CASE("surface profile: the envelope of a row of spheres has the mean height of circles",
          "[experiments][tracers]") {
  // Spheres of radius r in a square lattice of 2 r: mean height over their squares is
  // z + r (2 pi / 3) / 4, the half sphere's volume over the square, plus 0 where none covers.
  const double r = 0.005;
  std::vector<Vec3> x;
  for (int i = -40; i < 40; ++i)
    for (int j = -40; j < 40; ++j) x.emplace_back(2 * r * (i + 0.5), 2 * r * (j + 0.5), 0.0);
  const Profile p = surface_profile(x, std::vector<double>(x.size(), r),
                                    {.from_m = -0.1, .to_m = 0.1, .width_m = 0.2, .cell_m = 0.04});
  REQUIRE(p.height_m.size() == 5);
  CHECK_THAT(p.lateral_m.front(), WithinAbs(-0.08, 1e-12));
  // 5 %: 16 points for a sphere
  for (const double h : p.height_m) CHECK_THAT(h, WithinRel(r * std::numbers::pi / 6, 0.05));
}

TEST_CASE("furrow: areas are what went down and what came up", "[experiments][tracers]") {
  const Profile before{{-1, 0, 1}, {5, 5, 5}, 0.5};
  const Profile after{{-1, 0, 1}, {6, 2, 5.5}, 0.5};
  const FurrowArea area = furrow_area(before, after);
  CHECK_THAT(area.furrow_m2, WithinRel(1.5, 1e-12));
  CHECK_THAT(area.ridge_m2, WithinRel(0.75, 1e-12));
}
