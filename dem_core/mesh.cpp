// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace tilth {
namespace {

constexpr std::size_t max_sentences = 3;

const Vec3& corner(const Mesh& mesh, std::size_t triangle, std::size_t k) {
  return mesh.vertex_m[static_cast<std::size_t>(mesh.triangle[triangle][k])];
}

bool indices_in_range(const Mesh& mesh, std::vector<std::string>& found) {
  const auto n = static_cast<std::int32_t>(mesh.vertex_m.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const std::int32_t v : mesh.triangle[t])
      if (v < 0 || v >= n) {
        found.push_back(fmt::format("triangle {} names vertex {} of {}", t, v, n));
        return false;
      }
  return true;
}

void find_degenerate(const Mesh& mesh, std::vector<std::string>& found) {
  std::size_t told = 0;
  for (std::size_t t = 0; t < mesh.triangle.size() && told < max_sentences; ++t) {
    const Vec3 u = corner(mesh, t, 1) - corner(mesh, t, 0);
    const Vec3 v = corner(mesh, t, 2) - corner(mesh, t, 0);
    const double longest2 = std::max({u.squaredNorm(), v.squaredNorm(), (v - u).squaredNorm()});
    if (u.cross(v).norm() > 1e-9 * longest2) continue;
    found.push_back(fmt::format("triangle {} is degenerate (no area)", t));
    ++told;
  }
}

void find_open_edges(const Mesh& mesh, std::vector<std::string>& found) {
  std::map<std::array<std::int32_t, 2>, std::vector<std::size_t>> triangles_of;
  for (std::size_t i = 0; i < mesh.triangle.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      triangles_of[{mesh.triangle[i][k], mesh.triangle[i][(k + 1) % 3]}].push_back(i);
  std::size_t told = 0;
  for (const auto& [edge, triangles] : triangles_of) {
    if (told == max_sentences) return;
    const bool has_twin = triangles_of.contains({edge[1], edge[0]});
    if (triangles.size() == 1 && has_twin) continue;
    if (triangles.size() > 1)
      found.push_back(fmt::format(
          "edge {} -> {} belongs to the triangles {} and {} in the same sense: the orientation is not "
          "consistent or surfaces touch along it",
          edge[0], edge[1], triangles[0], triangles[1]));
    else
      found.push_back(fmt::format("edge {} -> {} has a triangle ({}) on one side only: the mesh is not "
                                  "closed", edge[0], edge[1], triangles[0]));
    ++told;
  }
}

}  // namespace

Vec3 triangle_normal(const Mesh& mesh, std::size_t triangle) {
  const Vec3& a = corner(mesh, triangle, 0);
  return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a).normalized();
}

double mesh_volume_m3(const Mesh& mesh) {
  double six_volumes = 0.0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    six_volumes += corner(mesh, t, 0).dot(corner(mesh, t, 1).cross(corner(mesh, t, 2)));
  return six_volumes / 6;
}

std::vector<std::string> problems(const Mesh& mesh) {
  std::vector<std::string> found;
  if (mesh.triangle.size() < 4) {
    found.push_back(fmt::format("{} triangles: a solid has at least 4", mesh.triangle.size()));
    return found;
  }
  if (!std::ranges::all_of(mesh.vertex_m, [](const Vec3& v) { return v.allFinite(); }))
    found.push_back("a vertex is not finite");
  if (!indices_in_range(mesh, found)) return found;
  find_degenerate(mesh, found);
  find_open_edges(mesh, found);
  if (found.empty() && !(mesh_volume_m3(mesh) > 0))
    found.push_back("the enclosed volume is negative: the triangles face inwards");
  return found;
}

Mesh merge_vertices(const std::vector<std::array<Vec3, 3>>& triangles) {
  Mesh mesh;
  std::map<std::array<double, 3>, std::int32_t> known;
  for (const auto& corners : triangles) {
    std::array<std::int32_t, 3> ids{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& v = corners[k];
      // + 0.0 makes -0 and 0 one key
      const auto [place, fresh] = known.try_emplace(
          {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}, static_cast<std::int32_t>(mesh.vertex_m.size()));
      if (fresh) mesh.vertex_m.push_back(v);
      ids[k] = place->second;
    }
    mesh.triangle.push_back(ids);
  }
  return mesh;
}

}  // namespace tilth
