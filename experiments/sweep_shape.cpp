// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/sweep_shape.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "dem_core/mesh.hpp"
#include "experiments/tool_shapes.hpp"

namespace tilth {
namespace {

/// Thickness along the vertical.
double vertical_thickness_m(const SweepShape& s) {
  return s.thickness_m / std::cos(s.rake_angle_rad);
}

/// How far the cutting edge has gone back at a distance y from the middle.
double setback_m(const SweepShape& s, double y_m) {
  return y_m / std::tan(0.5 * s.sweep_angle_rad);
}

/// Room for the shank along the travel: from the nose's flanks to the trailing edges.
double shank_room_m(const SweepShape& s) {
  return wing_depth_m(s) - setback_m(s, 0.5 * s.shank_width_m);
}

/// The half with y >= 0; it has no face in the plane y = 0.
class HalfSweep {
 public:
  HalfSweep(const SweepShape& shape, double top_m) : s_(shape) {
    add_wing();
    add_shank(top_m);
  }
  const std::vector<std::array<Vec3, 3>>& triangles() const { return triangles_; }

 private:
  /// Corners counter-clockwise seen from outside.
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    triangles_.push_back({a, b, c});
    triangles_.push_back({a, c, d});
  }

  Vec3 behind_edge(double back_m, double y_m, double z_m) const {
    return {-back_m - setback_m(s_, y_m), y_m, z_m};
  }

  Vec3 on_upper_face(double x_m, double y_m) const {
    const double half_rad = 0.5 * s_.sweep_angle_rad;
    return {x_m, y_m,
            std::tan(s_.rake_angle_rad) * (-x_m * std::sin(half_rad) - y_m * std::cos(half_rad))};
  }

  void add_wing() {
    const double depth_m = wing_depth_m(s_);
    const double rear_m = s_.wing_height_m - vertical_thickness_m(s_);
    const double flat_m = depth_m * vertical_thickness_m(s_) / s_.wing_height_m;
    const double y = 0.5 * s_.width_m;
    const Vec3 edge[] = {behind_edge(0, 0, 0), behind_edge(0, y, 0)};  // at the nose, at the tip
    const Vec3 flat[] = {behind_edge(flat_m, 0, 0), behind_edge(flat_m, y, 0)};
    const Vec3 low[] = {behind_edge(depth_m, 0, rear_m), behind_edge(depth_m, y, rear_m)};
    const Vec3 high[] = {behind_edge(depth_m, 0, s_.wing_height_m),
                         behind_edge(depth_m, y, s_.wing_height_m)};
    quad(edge[0], flat[0], flat[1], edge[1]);
    quad(flat[0], low[0], low[1], flat[1]);
    quad(low[0], high[0], high[1], low[1]);
    quad(edge[1], flat[1], low[1], high[1]);
    add_upper_face({edge[0], edge[1], high[1], high[0]});
  }

  /// The wing's face with the shank's footprint cut out of its inner side.
  void add_upper_face(std::vector<Vec3> outline) {
    const double half_m = 0.5 * s_.shank_width_m;
    const double middle_m = -0.5 * (setback_m(s_, half_m) + wing_depth_m(s_));
    const double front_m = middle_m + 0.5 * s_.shank_length_m;
    const double rear_m = middle_m - 0.5 * s_.shank_length_m;
    foot_ = {on_upper_face(rear_m, 0), on_upper_face(rear_m, half_m),
             on_upper_face(front_m, half_m), on_upper_face(front_m, 0)};
    outline.insert(outline.end(), foot_.begin(), foot_.end());
    std::vector<Eigen::Vector2d> plan;
    for (const Vec3& p : outline) plan.emplace_back(p.x(), p.y());
    const auto corner = [&outline](std::int32_t i) { return outline[static_cast<std::size_t>(i)]; };
    for (const auto& t : triangulate(plan))
      triangles_.push_back({corner(t[0]), corner(t[1]), corner(t[2])});
  }

  void add_shank(double top_m) {
    std::array<Vec3, 4> top = foot_;
    for (Vec3& p : top) p.z() = top_m;
    for (std::size_t k = 0; k < 3; ++k) quad(foot_[k + 1], foot_[k], top[k], top[k + 1]);
    quad(top[3], top[2], top[1], top[0]);
  }

  const SweepShape& s_;
  std::array<Vec3, 4> foot_;  ///< of the shank: rear and front, from the middle out and back
  std::vector<std::array<Vec3, 3>> triangles_;
};

Vec3 mirrored(const Vec3& p) { return {p.x(), -p.y(), p.z()}; }

}  // namespace

double wing_depth_m(const SweepShape& s) {
  return s.wing_height_m / (std::tan(s.rake_angle_rad) * std::sin(0.5 * s.sweep_angle_rad));
}

double sweep_length_m(const SweepShape& s) {
  return wing_depth_m(s) + setback_m(s, 0.5 * s.width_m);
}

std::vector<std::string> problems(const SweepShape& s) {
  std::vector<std::string> found;
  const auto require = [&found](bool good, const std::string& sentence) {
    if (!good) found.push_back(sentence);
  };
  require(s.sweep_angle_rad > 0 && s.sweep_angle_rad < std::numbers::pi,
          fmt::format("sweep_angle_rad = {}: must be between 0 and pi", s.sweep_angle_rad));
  require(s.rake_angle_rad > 0 && s.rake_angle_rad < 0.5 * std::numbers::pi,
          fmt::format("rake_angle_rad = {}: must be between 0 and pi/2", s.rake_angle_rad));
  for (const double length_m :
       {s.width_m, s.wing_height_m, s.thickness_m, s.shank_width_m, s.shank_length_m})
    require(length_m > 0, fmt::format("a length of the sweep is {}: must be > 0", length_m));
  if (!found.empty()) return found;
  require(s.wing_height_m > 1.05 * vertical_thickness_m(s),
          fmt::format("wing_height_m = {}: must be above 1.05 thickness_m / cos(rake) = {:.4g}",
                      s.wing_height_m, 1.05 * vertical_thickness_m(s)));
  require(s.shank_width_m < s.width_m,
          fmt::format("shank_width_m = {}: must be below the sweep's width {}", s.shank_width_m,
                      s.width_m));
  require(
      s.shank_length_m < 0.95 * shank_room_m(s),
      fmt::format("shank_length_m = {}: the share has room for {:.4g} behind the nose's flanks; "
                  "raise wing_height_m or make the shank smaller",
                  s.shank_length_m, std::max(0.95 * shank_room_m(s), 0.0)));
  return found;
}

Mesh sweep_mesh(const SweepShape& shape, double top_m) {
  const HalfSweep half(shape, top_m);
  std::vector<std::array<Vec3, 3>> all = half.triangles();
  for (const auto& [a, b, c] : half.triangles())
    all.push_back({mirrored(a), mirrored(c), mirrored(b)});
  return merge_vertices(all);
}

}  // namespace tilth
