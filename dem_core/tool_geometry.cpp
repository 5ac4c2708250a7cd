// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/tool_geometry.hpp"

#include <algorithm>

namespace tilth {
namespace {

Vec3 vec3(const double* v) { return {v[0], v[1], v[2]}; }

bool outside_box(const MeshFeature& f, const Vec3& x, double reach_m) {
  for (int k = 0; k < 3; ++k)
    if (x[k] < f.low_m[k] - reach_m || x[k] > f.high_m[k] + reach_m) return true;
  return false;
}

bool outside_region(const MeshFeatures& mesh, const MeshFeature& f, const Vec3& x, double margin_m) {
  for (int k = f.half_space_begin; k < f.half_space_end; ++k) {
    const HalfSpace& h = mesh.half_spaces[static_cast<std::size_t>(k)];
    const double s = vec3(h.normal).dot(x) - h.offset_m + margin_m;
    if (s < 0 || (s == 0 && !h.closed)) return true;
  }
  return false;
}

}  // namespace

Vec3 to_body_frame(const State& state, int tool, const Vec3& point_m, int lane) {
  return state.tool_orientation(tool, lane).conjugate() *
         (point_m - state.tool_position_m(tool, lane));
}

std::optional<FeatureDistance> feature_distance(const MeshFeatures& mesh, std::size_t feature,
                                                const Vec3& in_body_m, double reach_m,
                                                double max_depth_m, double margin_m) {
  const MeshFeature& f = mesh.features[feature];
  const double widest_m = std::max(reach_m, max_depth_m) + margin_m;
  if (outside_box(f, in_body_m, widest_m)) return std::nullopt;
  const Vec3 direction = vec3(f.direction);
  const Vec3 offset = in_body_m - vec3(f.point_m);
  const double along = offset.dot(direction);
  FeatureDistance d{along, direction};
  if (f.kind == FeatureKind::face) {
    if (!(along < reach_m) || along < -max_depth_m - margin_m) return std::nullopt;
  } else {
    const Vec3 away = f.kind == FeatureKind::edge ? Vec3(offset - along * direction) : offset;
    d.distance_m = away.norm();
    d.normal = away.normalized();
    if (!(d.distance_m < reach_m)) return std::nullopt;
  }
  if (outside_region(mesh, f, in_body_m, margin_m)) return std::nullopt;
  return d;
}

double tool_distance_m(const Tool& tool, const MeshFeatures& mesh, const Vec3& point_m,
                       double reach_m) {
  const Vec3 x = tool.orientation.normalized().conjugate() * (point_m - tool.position_m);
  double nearest_m = reach_m;
  for (std::size_t f = 0; f < mesh.features.size(); ++f)
    if (const auto d = feature_distance(mesh, f, x, reach_m, tool.max_depth_m))
      nearest_m = std::min(nearest_m, d->distance_m);
  return nearest_m;
}

double tool_extent_m(const Tool& tool) {
  double extent_m = 0.0;
  for (const Vec3& v : tool.mesh.vertex_m) extent_m = std::max(extent_m, v.norm());
  return extent_m;
}

}  // namespace tilth
