// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/surface_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tilth {
namespace {

/// Points of a plane on an even grid, each with the height of what covers it.
struct HeightMap {
  double x0_m = 0.0, y0_m = 0.0, step_x_m = 0.0, step_y_m = 0.0;
  int num_x = 0, num_y = 0;
  std::vector<double> height_m;  ///< [y][x]

  /// Indices of the points within `reach` of a coordinate.
  static std::pair<int, int> range(double centre, double reach, double first, double step, int n) {
    return {std::max(0, static_cast<int>(std::ceil((centre - reach - first) / step))),
            std::min(n - 1, static_cast<int>(std::floor((centre + reach - first) / step)))};
  }

  void cover(const Vec3& centre_m, double radius_m) {
    const auto [i0, i1] = range(centre_m.x(), radius_m, x0_m, step_x_m, num_x);
    const auto [j0, j1] = range(centre_m.y(), radius_m, y0_m, step_y_m, num_y);
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i) {
        const double dx = x0_m + i * step_x_m - centre_m.x();
        const double dy = y0_m + j * step_y_m - centre_m.y();
        const double cap2 = radius_m * radius_m - dx * dx - dy * dy;
        if (cap2 < 0) continue;
        double& h = height_m[static_cast<std::size_t>(j * num_x + i)];
        h = std::max(h, centre_m.z() + std::sqrt(cap2));
      }
  }
};

HeightMap empty_map(const ProfileFrame& f, int num_y, double spacing_m) {
  HeightMap map;
  map.num_x = std::max(1, static_cast<int>(std::ceil((f.to_m - f.from_m) / spacing_m)));
  map.num_y = num_y;
  map.step_x_m = (f.to_m - f.from_m) / map.num_x;
  map.step_y_m = f.width_m / num_y;
  map.x0_m = f.from_m + 0.5 * map.step_x_m;
  map.y0_m = -0.5 * f.width_m + 0.5 * map.step_y_m;
  map.height_m.assign(static_cast<std::size_t>(map.num_x) * static_cast<std::size_t>(num_y), 0.0);
  return map;
}

}  // namespace

Profile surface_profile(const std::vector<Vec3>& position_m, const std::vector<double>& radius_m,
                        const ProfileFrame& f) {
  const double mean_m = std::accumulate(radius_m.begin(), radius_m.end(), 0.0) /
                        static_cast<double>(std::max<std::size_t>(radius_m.size(), 1));
  const int cells = std::max(1, static_cast<int>(std::lround(f.width_m / f.cell_m)));
  const int per_cell = std::max(1, static_cast<int>(std::ceil(f.width_m / cells / (0.5 * mean_m))));
  HeightMap map = empty_map(f, cells * per_cell, 0.5 * mean_m);
  for (std::size_t i = 0; i < position_m.size(); ++i) map.cover(position_m[i], radius_m[i]);
  Profile profile{.cell_m = f.width_m / cells};
  const auto row = static_cast<std::ptrdiff_t>(map.num_x) * per_cell;
  for (int c = 0; c < cells; ++c) {
    const auto first = map.height_m.begin() + c * row;
    profile.lateral_m.push_back(-0.5 * f.width_m + (c + 0.5) * profile.cell_m);
    profile.height_m.push_back(std::accumulate(first, first + row, 0.0) / static_cast<double>(row));
  }
  return profile;
}

FurrowArea furrow_area(const Profile& before, const Profile& after) {
  FurrowArea area;
  for (std::size_t k = 0; k < before.height_m.size(); ++k) {
    const double rise_m2 = (after.height_m[k] - before.height_m[k]) * before.cell_m;
    (rise_m2 < 0 ? area.furrow_m2 : area.ridge_m2) += std::abs(rise_m2);
  }
  return area;
}

}  // namespace tilth
