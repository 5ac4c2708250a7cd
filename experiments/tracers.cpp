// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/tracers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tilth {
namespace {

std::vector<int> aggregates_at(const Vec3& site_m, double size_m,
                               const std::vector<Vec3>& position_m) {
  std::vector<int> inside;
  int nearest = 0;
  double smallest_m2 = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(position_m.size()); ++i) {
    const Vec3 offset_m = position_m[static_cast<std::size_t>(i)] - site_m;
    if (offset_m.cwiseAbs().maxCoeff() <= 0.5 * size_m) inside.push_back(i);
    if (offset_m.squaredNorm() >= smallest_m2) continue;
    smallest_m2 = offset_m.squaredNorm();
    nearest = i;
  }
  return inside.empty() ? std::vector<int>{nearest} : inside;
}

}  // namespace

std::vector<Tracer> place_tracers(const TracerGrid& grid, double from_m, double to_m,
                                  double surface_m, const std::vector<Vec3>& position_m) {
  const int num_along = 1 + static_cast<int>(std::floor((to_m - from_m) / grid.spacing_m + 1e-9));
  std::vector<Tracer> tracers;
  for (const double depth_m : grid.depth_m)
    for (const double lateral_m : grid.lateral_m)
      for (int k = 0; k < num_along; ++k) {
        const Vec3 site_m(from_m + k * grid.spacing_m, lateral_m, surface_m - depth_m);
        tracers.push_back(
            {depth_m, lateral_m, site_m, aggregates_at(site_m, grid.size_m, position_m)});
      }
  return tracers;
}

Vec3 tracer_displacement_m(const Tracer& tracer, const std::vector<Vec3>& before_m,
                           const std::vector<Vec3>& after_m) {
  Vec3 sum_m = Vec3::Zero();
  for (const int i : tracer.particles)
    sum_m += after_m[static_cast<std::size_t>(i)] - before_m[static_cast<std::size_t>(i)];
  return sum_m / static_cast<double>(tracer.particles.size());
}

std::vector<TracerMean> tracer_means(std::span<const Tracer> tracers,
                                     std::span<const Vec3> displacement_m) {
  std::vector<TracerMean> means;
  for (std::size_t begin = 0, end = 0; begin < tracers.size(); begin = end) {
    const Tracer& first = tracers[begin];
    TracerMean m{.depth_m = first.depth_m, .lateral_m = first.lateral_m};
    for (end = begin; end < tracers.size() && tracers[end].depth_m == first.depth_m &&
                      tracers[end].lateral_m == first.lateral_m;
         ++end)
      m.mean_m += displacement_m[end];
    m.num_tracers = static_cast<int>(end - begin);
    m.mean_m /= m.num_tracers;
    for (std::size_t k = begin; k < end; ++k) m.sd_m += (displacement_m[k] - m.mean_m).cwiseAbs2();
    m.sd_m = (m.sd_m / std::max(m.num_tracers - 1, 1)).cwiseSqrt();
    means.push_back(m);
  }
  return means;
}

std::string tracer_label(double depth_m, double lateral_m) {
  return fmt::format("{:g}m_{:g}m", depth_m, lateral_m);
}

}  // namespace tilth
