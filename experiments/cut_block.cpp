// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/cut_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tilth {
namespace {

double sphere_m3(double radius_m) {
  return 4.0 / 3.0 * std::numbers::pi * radius_m * radius_m * radius_m;
}

double solid_m3(const PackingSpec& spec) { return (1 - spec.porosity) * container_volume_m3(spec); }

PackingSpec block_spec(const PackingSpec& spec) {
  const double typical_radius_m =
      std::cbrt(solid_m3(spec) / spec.num_particles / sphere_m3(1.0));
  const double side_m = std::hypot(spec.size_m.x(), spec.size_m.z()) + 4 * typical_radius_m;
  PackingSpec block = spec;
  block.size_m = {side_m, spec.size_m.y(), side_m};
  block.num_particles = static_cast<int>(
      std::lround(spec.num_particles * block.size_m.prod() / spec.size_m.prod()));
  return block;
}

Vec3 turned(const Vec3& x, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * x.x() + s * x.z(), x.y(), c * x.z() - s * x.x()};
}

/// Distance behind the nearest face in x or z, negative outside.
double depth_m(const Vec3& x, const Vec3& box_size_m) {
  return std::min({x.x(), x.z(), box_size_m.x() - x.x(), box_size_m.z() - x.z()});
}

}  // namespace

Packing cut_from(const Packing& block, const Vec3& block_size_m, const Vec3& box_size_m,
                 double solid_m3, double angle_rad) {
  std::vector<Vec3> position_m;
  for (const Vec3& x : block.position_m)
    position_m.push_back(turned(x - 0.5 * block_size_m, angle_rad) + 0.5 * box_size_m);
  std::vector<std::size_t> by_depth(position_m.size());
  std::iota(by_depth.begin(), by_depth.end(), std::size_t{0});
  std::ranges::stable_sort(by_depth, std::ranges::greater{}, [&](std::size_t i) {
    return depth_m(position_m[i], box_size_m);
  });
  Packing cut;
  double sum_m = 0.0;
  for (const std::size_t i : by_depth) {
    if (solid_m3 <= 0) break;
    solid_m3 -= sphere_m3(block.radius_m[i]);
    cut.position_m.push_back(position_m[i]);
    cut.radius_m.push_back(block.radius_m[i]);
    sum_m += block.radius_m[i];
  }
  cut.mean_radius_m = sum_m / static_cast<double>(cut.radius_m.size());
  return cut;
}

std::shared_ptr<const Packing> cut_block(PackingStore& packings, const PackingSpec& spec,
                                         double angle_rad) {
  if (angle_rad == 0) return packings.get(spec);
  const PackingSpec from = block_spec(spec);
  const Packing cut =
      cut_from(*packings.get(from), from.size_m, spec.size_m, solid_m3(spec), angle_rad);
  return std::make_shared<Packing>(relaxed_packing(spec, cut.radius_m, cut.position_m));
}

}  // namespace tilth
