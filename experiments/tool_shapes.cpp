// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/tool_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace tilth {
namespace {

using Index = std::int32_t;
using Vec2 = Eigen::Vector2d;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - b).y() - (b - a).y() * (c - b).x();
}

/// True where p lies in the triangle or on its rim.
bool covers(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/// Ring of a body of revolution: its vertices, or one vertex on the axis.
std::vector<Index> add_ring(Mesh& mesh, const ProfilePoint& p, int num_sides) {
  const double step_rad = 2 * std::numbers::pi / num_sides;
  const double corner_m = p.radius_m * std::sqrt(step_rad / std::sin(step_rad));
  std::vector<Index> ring;
  for (int k = 0; k < (p.radius_m > 0 ? num_sides : 1); ++k) {
    ring.push_back(static_cast<Index>(mesh.vertex_m.size()));
    mesh.vertex_m.emplace_back(corner_m * std::cos(k * step_rad), corner_m * std::sin(k * step_rad),
                               p.height_m);
  }
  return ring;
}

}  // namespace

std::vector<std::array<Index, 3>> triangulate(const std::vector<Vec2>& outline) {
  std::vector<Index> left(outline.size());
  std::iota(left.begin(), left.end(), 0);
  const auto point = [&outline](Index i) { return outline[static_cast<std::size_t>(i)]; };
  std::vector<std::array<Index, 3>> triangles;
  while (left.size() > 2) {
    const std::size_t n = left.size();
    std::size_t ear = n;
    for (std::size_t k = 0; k < n && ear == n; ++k) {
      const std::array<Index, 3> t = {left[(k + n - 1) % n], left[k], left[(k + 1) % n]};
      if (!(turn(point(t[0]), point(t[1]), point(t[2])) > 0)) continue;
      const bool empty = std::ranges::none_of(left, [&](Index i) {
        return std::ranges::find(t, i) == t.end() &&
               covers(point(t[0]), point(t[1]), point(t[2]), point(i));
      });
      if (empty) ear = k;
    }
    if (ear == n) throw std::invalid_argument("the outline of a polygon crosses itself");
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

Mesh box_mesh(const Vec3& low_m, const Vec3& high_m) {
  return prism_mesh({{low_m.x(), low_m.y()},
                     {high_m.x(), low_m.y()},
                     {high_m.x(), high_m.y()},
                     {low_m.x(), high_m.y()}},
                    low_m.z(), high_m.z());
}

Mesh prism_mesh(const std::vector<Vec2>& outline_m, double low_m, double high_m) {
  Mesh mesh;
  for (const double z : {low_m, high_m})
    for (const Vec2& p : outline_m) mesh.vertex_m.emplace_back(p.x(), p.y(), z);
  const Index n = static_cast<Index>(outline_m.size());
  for (const auto& t : triangulate(outline_m)) {
    mesh.triangle.push_back({t[0], t[2], t[1]});
    mesh.triangle.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (Index k = 0; k < n; ++k) {
    const Index next = (k + 1) % n;
    mesh.triangle.push_back({k, next, next + n});
    mesh.triangle.push_back({k, next + n, k + n});
  }
  return mesh;
}

Mesh revolution_mesh(const std::vector<ProfilePoint>& profile, int num_sides) {
  Mesh mesh;
  const std::size_t n = static_cast<std::size_t>(num_sides);
  std::vector<Index> below = add_ring(mesh, profile.front(), num_sides);
  for (std::size_t p = 1; p < profile.size(); ++p) {
    const std::vector<Index> above = add_ring(mesh, profile[p], num_sides);
    const auto of = [n](const std::vector<Index>& ring, std::size_t k) {
      return ring[ring.size() == 1 ? 0 : k % n];
    };
    for (std::size_t k = 0; k < n; ++k) {
      if (below.size() > 1)
        mesh.triangle.push_back({of(below, k), of(below, k + 1), of(above, k + 1)});
      if (above.size() > 1) mesh.triangle.push_back({of(below, k), of(above, k + 1), of(above, k)});
    }
    below = above;
  }
  return mesh;
}

Mesh cone_mesh(double apex_angle_rad, double base_diameter_m, double shaft_diameter_m,
               double length_m, int num_sides) {
  const double base_m = 0.5 * base_diameter_m;
  const double height_m = base_m / std::tan(0.5 * apex_angle_rad);
  std::vector<ProfilePoint> profile = {{0, 0}, {base_m, height_m}};
  if (shaft_diameter_m < base_diameter_m) profile.push_back({0.5 * shaft_diameter_m, height_m});
  profile.push_back({0.5 * shaft_diameter_m, length_m});
  profile.push_back({0, length_m});
  return revolution_mesh(profile, num_sides);
}

double area_below_m2(const Mesh& mesh, double level_m) {
  double area_m2 = 0.0;
  for (const auto& t : mesh.triangle) {
    std::vector<Vec3> below;  // the triangle clipped by the plane z = level
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = mesh.vertex_m[static_cast<std::size_t>(t[k])];
      const Vec3& b = mesh.vertex_m[static_cast<std::size_t>(t[(k + 1) % 3])];
      if (a.z() <= level_m) below.push_back(a);
      if ((a.z() <= level_m) != (b.z() <= level_m))
        below.push_back(a + (level_m - a.z()) / (b.z() - a.z()) * (b - a));
    }
    for (std::size_t k = 2; k < below.size(); ++k)
      area_m2 += 0.5 * (below[k - 1] - below[0]).cross(below[k] - below[0]).norm();
  }
  return area_m2;
}

Mesh vane_mesh(double diameter_m, double height_m, double blade_thickness_m) {
  const double r = 0.5 * diameter_m;
  const double t = 0.5 * blade_thickness_m;
  return prism_mesh({{r, -t}, {r, t}, {t, t}, {t, r}, {-t, r}, {-t, t}, {-r, t}, {-r, -t},
                     {-t, -t}, {-t, -r}, {t, -r}, {t, -t}},
                    0.0, height_m);
}

}  // namespace tilth
