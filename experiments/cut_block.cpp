// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/cut_block.hpp"

#include <cmath>
#include <numbers>

namespace tilth {
namespace {

/// Mean radius if the radii were all alike; only sizes the margin.
double typical_radius_m(const PackingSpec& spec) {
  const double solid_m3 = (1 - spec.porosity) * container_volume_m3(spec);
  return std::cbrt(solid_m3 / spec.num_particles / (4.0 / 3.0 * std::numbers::pi));
}

PackingSpec block_spec(const PackingSpec& spec, double angle_rad) {
  const double c = std::abs(std::cos(angle_rad));
  const double s = std::abs(std::sin(angle_rad));
  const double margin_m = 2 * typical_radius_m(spec);
  PackingSpec block = spec;
  block.size_m = {c * spec.size_m.x() + s * spec.size_m.z() + 2 * margin_m, spec.size_m.y(),
                  s * spec.size_m.x() + c * spec.size_m.z() + 2 * margin_m};
  block.num_particles = static_cast<int>(
      std::lround(spec.num_particles * block.size_m.prod() / spec.size_m.prod()));
  return block;
}

/// Turned by the angle about y (z towards x), as from the middle of one box to that of another.
Vec3 turned(const Vec3& from_middle_m, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * from_middle_m.x() + s * from_middle_m.z(), from_middle_m.y(),
          c * from_middle_m.z() - s * from_middle_m.x()};
}

}  // namespace

std::shared_ptr<const Packing> cut_block(PackingStore& packings, const PackingSpec& spec,
                                         double angle_rad) {
  if (angle_rad == 0) return packings.get(spec);
  const PackingSpec from = block_spec(spec, angle_rad);
  const auto block = packings.get(from);
  std::vector<Vec3> position_m;
  std::vector<double> radius_m;
  double sum_m = 0.0;
  for (std::size_t i = 0; i < block->radius_m.size(); ++i) {
    const Vec3 x = turned(block->position_m[i] - 0.5 * from.size_m, angle_rad) + 0.5 * spec.size_m;
    if (x.minCoeff() < 0 || (spec.size_m - x).minCoeff() < 0) continue;
    position_m.push_back(x);
    radius_m.push_back(block->radius_m[i]);
    sum_m += block->radius_m[i];
  }
  auto cut = std::make_shared<Packing>();
  cut->mean_radius_m = sum_m / static_cast<double>(radius_m.size());
  cut->largest_overlap = block->largest_overlap;
  for (const int i : spatial_order(position_m, 2.5 * cut->mean_radius_m)) {
    cut->position_m.push_back(position_m[static_cast<std::size_t>(i)]);
    cut->radius_m.push_back(radius_m[static_cast<std::size_t>(i)]);
  }
  return cut;
}

}  // namespace tilth
