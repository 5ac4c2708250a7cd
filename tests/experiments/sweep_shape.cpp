// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The parametric sweep: closed, of its volume, width and rake; tools cut by the surface.
#include "experiments/sweep_shape.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "dem_core/mesh.hpp"
#include "dem_core/mesh_features.hpp"
#include "experiments/tool_shapes.hpp"

using namespace tilth;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// Unlike in every number: narrow and wide, flat and steep, thick and thin.
std::vector<SweepShape> shapes() {
  std::vector<SweepShape> all = {SweepShape{}};
  for (const double sweep_deg : {40.0, 70.0, 120.0, 165.0})
    for (const double rake_deg : {13.5, 16.0, 44.0, 70.0})
      for (const double width_m : {0.15, 0.33})
        all.push_back({.width_m = width_m,
                       .sweep_angle_rad = sweep_deg * degree,
                       .rake_angle_rad = rake_deg * degree,
                       .wing_height_m = 0.05,
                       .thickness_m = 0.004,
                       .shank_width_m = 0.006,
                       .shank_length_m = 0.007});
  return all;
}

double volume_m3(const SweepShape& s, double top_m) {
  const double half = 0.5 * s.sweep_angle_rad, slope = std::tan(s.rake_angle_rad);
  const double low = s.wing_height_m - s.thickness_m / std::cos(s.rake_angle_rad);
  const double section = (s.wing_height_m * s.wing_height_m - low * low) / (2 * slope);
  const double depth = s.wing_height_m / (slope * std::sin(half));
  const double middle = 0.5 * (depth + 0.5 * s.shank_width_m / std::tan(half));
  const double foot = slope * (middle * std::sin(half) - 0.25 * s.shank_width_m * std::cos(half));
  return s.width_m / std::sin(half) * section + s.shank_width_m * s.shank_length_m * (top_m - foot);
}

}  // namespace

TEST_CASE("sweep shape: every sweep is a closed solid of its volume and width",
          "[experiments][sweep]") {
  for (const SweepShape& s : shapes()) {
    CAPTURE(s.sweep_angle_rad, s.rake_angle_rad, s.width_m);
    REQUIRE(problems(s) == std::vector<std::string>{});
    const Mesh mesh = sweep_mesh(s, 0.3);
    CHECK(problems(mesh) == std::vector<std::string>{});
    CHECK_THAT(mesh_volume_m3(mesh), WithinRel(volume_m3(s, 0.3), 1e-10));  // rounding
    Vec3 low = mesh.vertex_m.front(), high = low;
    for (const Vec3& v : mesh.vertex_m) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    CHECK(high.y() - low.y() == s.width_m);
    CHECK(high.x() == 0);
    CHECK(low.z() == 0);
    CHECK(high.z() == 0.3);
    CHECK_THAT(-low.x(), WithinRel(sweep_length_m(s), 1e-12));
  }
}

TEST_CASE("sweep shape: faces stand at the rake, cutting edges at half the sweep angle",
          "[experiments][sweep]") {
  const SweepShape s;
  const Mesh mesh = sweep_mesh(s, 0.3);
  int upper = 0, under = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Vec3 n = triangle_normal(mesh, t);
    if (std::abs(n.z()) < 0.01 || std::abs(n.z()) > 0.999) continue;
    // the angle between a face and the horizontal is that between their normals
    CHECK_THAT(std::acos(std::abs(n.z())), WithinAbs(s.rake_angle_rad, 1e-12));
    // across the edge: its horizontal part is at right angles to the cutting edge
    CHECK_THAT(std::abs(n.y() / n.x()), WithinRel(1 / std::tan(0.5 * s.sweep_angle_rad), 1e-12));
    ++(n.z() > 0 ? upper : under);
  }
  CHECK(upper == 12);  // an octagon of 8 corners on either side of the middle
  CHECK(under == 4);
}

TEST_CASE("sweep shape: a mirrored sweep is the same sweep", "[experiments][sweep]") {
  const Mesh mesh = sweep_mesh({}, 0.3);
  for (const Vec3& v : mesh.vertex_m) {
    const Vec3 twin(v.x(), -v.y(), v.z());
    CHECK(std::ranges::find(mesh.vertex_m, twin) != mesh.vertex_m.end());
  }
}

TEST_CASE("sweep shape: what cannot be built is said with the limit", "[experiments][sweep]") {
  const auto complaint = [](const SweepShape& s) {
    const auto found = problems(s);
    return found.empty() ? std::string("none") : found.front();
  };
  CHECK_THAT(complaint({.rake_angle_rad = 1.6}), Contains("between 0 and pi/2"));
  CHECK_THAT(complaint({.sweep_angle_rad = 3.2}), Contains("between 0 and pi"));
  CHECK_THAT(complaint({.width_m = -0.1}), Contains("must be > 0"));
  CHECK_THAT(complaint({.thickness_m = 0.03}), Contains("wing_height_m = 0.03: must be above"));
  CHECK_THAT(complaint({.shank_width_m = 0.3}), Contains("shank_width_m = 0.3: must be below"));
  CHECK_THAT(complaint({.shank_length_m = 0.2}), Contains("the share has room for"));
}

TEST_CASE("tool shapes: area below a plane cuts the triangles", "[experiments][sweep]") {
  const Mesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  CHECK_THAT(area_below_m2(box, 1.25), WithinRel(2 + 6 * 1.25, 1e-12));
  CHECK_THAT(area_below_m2(box, 4), WithinRel(22.0, 1e-12));
  CHECK(area_below_m2(box, -1) == 0);
}
