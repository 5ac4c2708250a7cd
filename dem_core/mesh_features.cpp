// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/mesh_features.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "dem_core/mesh.hpp"

namespace tilth {
namespace {

std::size_t as_size(std::int64_t k) { return static_cast<std::size_t>(k); }

constexpr double coplanar_rad = 1e-6;

/// Half space through a point.
HalfSpace half_space(const Vec3& normal, const Vec3& point_m) {
  static const Vec3 skew(0.5271, 0.3317, 0.7824);
  return {.normal = {normal.x(), normal.y(), normal.z()},
          .offset_m = normal.dot(point_m),
          .closed = normal.dot(skew) > 0};
}

/// The other side of it, boundary and rounding included.
HalfSpace opposite(const HalfSpace& h) {
  return {.normal = {-h.normal[0], -h.normal[1], -h.normal[2]},
          .offset_m = -h.offset_m,
          .closed = !h.closed};
}

/// An edge a -> b with the triangle left of it and the triangle left of b -> a.
struct Edge {
  std::int32_t a = 0, b = 0;
  std::size_t left = 0, right = 0;
  HalfSpace inside_left, inside_right;  ///< bounds of the two prisms
  HalfSpace after_a, before_b;
  Vec3 direction = Vec3::Zero();
  bool convex = false;
};

class FeatureBuilder {
 public:
  explicit FeatureBuilder(const Mesh& mesh) : mesh_(mesh) {
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
      normal_.push_back(triangle_normal(mesh, t));
    find_edges();
  }

  MeshFeatures build() {
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t) add_face(t);
    for (const Edge& e : edges_)
      if (e.convex) add_edge(e);
    for (std::size_t v = 0; v < mesh_.vertex_m.size(); ++v) add_vertex(static_cast<std::int32_t>(v));
    return std::move(built_);
  }

 private:
  const Vec3& vertex(std::int32_t id) const { return mesh_.vertex_m[as_size(id)]; }

  void find_edges() {
    std::map<std::array<std::int32_t, 2>, std::size_t> left_of;
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        left_of[{mesh_.triangle[t][k], mesh_.triangle[t][(k + 1) % 3]}] = t;
    edges_of_triangle_.resize(mesh_.triangle.size());
    edges_of_vertex_.resize(mesh_.vertex_m.size());
    for (const auto& [ends, left] : left_of) {
      if (ends[0] > ends[1]) continue;
      const std::size_t id = edges_.size();
      edges_.push_back(make_edge(ends[0], ends[1], left, left_of.at({ends[1], ends[0]})));
      edges_of_triangle_[left].push_back(id);
      edges_of_triangle_[edges_.back().right].push_back(id);
      edges_of_vertex_[as_size(ends[0])].push_back(id);
      edges_of_vertex_[as_size(ends[1])].push_back(id);
    }
  }

  Edge make_edge(std::int32_t a, std::int32_t b, std::size_t left, std::size_t right) const {
    Edge e;
    e.a = a;
    e.b = b;
    e.left = left;
    e.right = right;
    e.direction = (vertex(b) - vertex(a)).normalized();
    const Vec3 into_left = normal_[left].cross(e.direction);
    const Vec3 into_right = e.direction.cross(normal_[right]);
    const double rise = normal_[left].dot(into_right);  // of the right face over the left one
    e.convex = rise < -coplanar_rad;
    e.inside_left = half_space(into_left, vertex(a));
    // Coplanar neighbours share one boundary to the last bit.
    e.inside_right = std::abs(rise) <= coplanar_rad ? opposite(e.inside_left)
                                                    : half_space(into_right, vertex(a));
    e.after_a = half_space(e.direction, vertex(a));
    e.before_b = half_space(-e.direction, vertex(b));
    return e;
  }

  void add(FeatureKind kind, const Vec3& point_m, const Vec3& direction,
           const std::vector<HalfSpace>& region, std::initializer_list<std::int32_t> corners) {
    MeshFeature f{.kind = kind};
    f.half_space_begin = static_cast<int>(built_.half_spaces.size());
    built_.half_spaces.insert(built_.half_spaces.end(), region.begin(), region.end());
    f.half_space_end = static_cast<int>(built_.half_spaces.size());
    for (int k = 0; k < 3; ++k) {
      f.point_m[k] = point_m[k];
      f.direction[k] = direction[k];
      f.low_m[k] = f.high_m[k] = vertex(*corners.begin())[k];
      for (const std::int32_t c : corners) {
        f.low_m[k] = std::min(f.low_m[k], vertex(c)[k]);
        f.high_m[k] = std::max(f.high_m[k], vertex(c)[k]);
      }
    }
    built_.features.push_back(f);
  }

  void add_face(std::size_t t) {
    std::vector<HalfSpace> region;
    for (const std::size_t id : edges_of_triangle_[t])
      region.push_back(edges_[id].left == t ? edges_[id].inside_left : edges_[id].inside_right);
    const auto& ids = mesh_.triangle[t];
    add(FeatureKind::face, vertex(ids[0]), normal_[t], region, {ids[0], ids[1], ids[2]});
  }

  void add_edge(const Edge& e) {
    add(FeatureKind::edge, vertex(e.a), e.direction,
        {opposite(e.inside_left), opposite(e.inside_right), e.after_a, e.before_b}, {e.a, e.b});
  }

  void add_vertex(std::int32_t v) {
    std::vector<HalfSpace> region;
    std::vector<Vec3> outgoing;
    for (const std::size_t id : edges_of_vertex_[as_size(v)]) {
      const Edge& e = edges_[id];
      region.push_back(opposite(e.a == v ? e.after_a : e.before_b));
      outgoing.push_back(e.a == v ? e.direction : Vec3(-e.direction));
    }
    if (is_peak(v, outgoing)) add(FeatureKind::vertex, vertex(v), Vec3::Zero(), region, {v});
  }

  /// True where the directions pointing away from every edge of the vertex form an open cone outside.
  bool is_peak(std::int32_t v, const std::vector<Vec3>& outgoing) const {
    const auto largest = [&outgoing](const Vec3& d) {
      double most = -1.0;
      for (const Vec3& e : outgoing) most = std::max(most, d.dot(e));
      return most;
    };
    Vec3 middle = Vec3::Zero();  // of the cone's extreme rays
    for (std::size_t j = 0; j < outgoing.size(); ++j)
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3 ray = outgoing[j].cross(outgoing[k]);
        if (ray.norm() < 1e-9) continue;
        for (const Vec3& d : {Vec3(ray.normalized()), Vec3(-ray.normalized())})
          if (largest(d) < 1e-9) middle += d;
      }
    if (middle.norm() < 1e-9 || !(largest(middle.normalized()) < -coplanar_rad)) return false;
    return middle.dot(outward(v)) > 0;
  }

  /// Sum of the face normals weighted with the angle each face has at the vertex.
  Vec3 outward(std::int32_t v) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        if (mesh_.triangle[t][k] != v) continue;
        const Vec3 to_next = vertex(mesh_.triangle[t][(k + 1) % 3]) - vertex(v);
        const Vec3 to_last = vertex(mesh_.triangle[t][(k + 2) % 3]) - vertex(v);
        sum += std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last)) * normal_[t];
      }
    return sum;
  }

  const Mesh& mesh_;
  std::vector<Vec3> normal_;
  std::vector<Edge> edges_;
  std::vector<std::vector<std::size_t>> edges_of_triangle_, edges_of_vertex_;
  MeshFeatures built_;
};

}  // namespace

MeshFeatures mesh_features(const Mesh& mesh) { return FeatureBuilder(mesh).build(); }

}  // namespace tilth
