// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/heap_profile.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/curve_features.hpp"

namespace tilth {
namespace {

std::size_t cells_along(double length_m, double cell_m) {
  return static_cast<std::size_t>(std::max(1.0, std::floor(length_m / cell_m)));
}

/// Cell of a coordinate; what lies outside counts into the outermost.
std::size_t cell_of(double x_m, double cell_m, std::size_t num_cells) {
  const double k = std::clamp(std::floor(x_m / cell_m), 0.0, static_cast<double>(num_cells - 1));
  return static_cast<std::size_t>(k);
}

}  // namespace

std::vector<double> heap_profile_m(const Specimen& specimen, int lane, const HeapFrame& frame) {
  const std::size_t nx = cells_along(frame.length_m, frame.cell_m);
  const std::size_t ny = cells_along(frame.thickness_m, frame.cell_m);
  const double cell_y_m = frame.thickness_m / static_cast<double>(ny);
  std::vector<double> top_m(nx * ny, 0.0);
  for (int i = specimen.model.num_fixed; i < specimen.model.num_particles(); ++i) {
    const Vec3 x = specimen.state.position_m(i, lane);
    double& top = top_m[cell_of(x.x(), frame.cell_m, nx) * ny + cell_of(x.y(), cell_y_m, ny)];
    top = std::max(top, x.z() + specimen.model.radius_m[static_cast<std::size_t>(i)] - frame.floor_m);
  }
  std::vector<double> profile_m(nx, 0.0);
  for (std::size_t k = 0; k < top_m.size(); ++k)
    profile_m[k / ny] += top_m[k] / static_cast<double>(ny);
  return profile_m;
}

HeapShape heap_shape(const std::vector<double>& profile_m, double cell_m) {
  HeapShape shape;
  const auto toe = std::ranges::find_if(profile_m, [=](double h) { return h < 0.75 * cell_m; });
  shape.runout_m = static_cast<double>(toe - profile_m.begin()) * cell_m;
  if (profile_m.size() >= 2) shape.height_m = 0.5 * (profile_m[0] + profile_m[1]);
  std::vector<double> x_m, height_m;
  for (std::size_t k = 0; k < profile_m.size(); ++k) {
    const double x = (static_cast<double>(k) + 0.5) * cell_m;
    if (x < 0.15 * shape.runout_m || x > 0.85 * shape.runout_m) continue;
    x_m.push_back(x);
    height_m.push_back(profile_m[k]);
  }
  shape.num_points = static_cast<int>(x_m.size());
  if (shape.num_points >= 3) shape.angle_rad = std::atan(-fit_line(x_m, height_m).slope);
  return shape;
}

}  // namespace tilth
