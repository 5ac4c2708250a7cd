// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Blocks cut at an angle from a larger packing.
#include <cmath>
#include <numbers>

#include "experiments/cut_block.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinRel;

namespace {

PackingSpec box(int num_particles, std::uint64_t seed = 1) {
  return {.shape = ContainerShape::box,
          .size_m = Vec3(0.06, 0.06, 0.036),
          .num_particles = num_particles,
          .seed = seed};
}

double solid_m3(const Packing& p) {
  double sum = 0;
  for (const double r : p.radius_m) sum += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return sum;
}

}  // namespace

TEST_CASE("Cut block: angle 0 is the packing of the box itself", "[experiments][cut]") {
  REQUIRE(cut_block(packings(), box(150), 0) == packings().get(box(150)));
}

TEST_CASE("Cut block: grains are as large and as many as in the box itself, and inside it",
          "[experiments][cut]") {
  const auto own = packings().get(box(300));
  for (const double angle_rad : {0.3, -0.8, std::numbers::pi / 2}) {
    const auto cut = cut_block(packings(), box(300), angle_rad);
    CAPTURE(angle_rad, cut->radius_m.size());
    // 0.02: the mean of 300 radii of 14 % standard deviation is known to 0.8 %
    REQUIRE_THAT(cut->mean_radius_m, WithinRel(own->mean_radius_m, 0.02));
    // 0.08: a section has no loose wall layer, so it is a little denser than its container; grains
    // on the faces count by their centres (5 % of the volume of one layer)
    REQUIRE_THAT(solid_m3(*cut), WithinRel(solid_m3(*own), 0.10));
    for (const Vec3& x : cut->position_m)
      for (int axis = 0; axis < 3; ++axis) {
        REQUIRE(x[axis] >= 0);
        REQUIRE(x[axis] <= box(300).size_m[axis]);
      }
  }
}

TEST_CASE("Cut block: turning keeps the distances between grains", "[experiments][cut]") {
  // A quarter turn of a cube: the block is the same for +90 and -90 degrees, and the two cuts are
  // each other turned by a half turn about y.
  PackingSpec cube = box(200);
  cube.size_m = Vec3::Constant(0.05);
  const auto a = cut_block(packings(), cube, std::numbers::pi / 2);
  const auto b = cut_block(packings(), cube, -std::numbers::pi / 2);
  REQUIRE(a->radius_m.size() == b->radius_m.size());
  for (std::size_t i = 0; i < a->radius_m.size(); ++i) {
    const Vec3 mirrored(0.05 - a->position_m[i].x(), a->position_m[i].y(),
                        0.05 - a->position_m[i].z());
    double nearest_m = 1;
    for (const Vec3& x : b->position_m) nearest_m = std::min(nearest_m, (x - mirrored).norm());
    REQUIRE(nearest_m < 1e-12);
  }
}

TEST_CASE("Cut block: x and z change places in a quarter turn, by the right hand about y",
          "[experiments][cut]") {
  // The block of a quarter turn is long in z where the box is long in x. A grain near the block's
  // top (+z) comes to lie near the box's +x side.
  PackingSpec spec = box(150);
  const auto cut = cut_block(packings(), spec, std::numbers::pi / 2);
  PackingSpec block = spec;
  const double solid = (1 - spec.porosity) * container_volume_m3(spec) / spec.num_particles;
  const double margin_m = 2 * std::cbrt(solid / (4.0 / 3.0 * std::numbers::pi));
  block.size_m = Vec3(0.036 + 2 * margin_m, 0.06, 0.06 + 2 * margin_m);
  block.num_particles = static_cast<int>(
      std::lround(150 * block.size_m.prod() / spec.size_m.prod()));
  const auto from = packings().get(block);
  std::size_t found = 0;
  for (std::size_t i = 0; i < from->radius_m.size(); ++i) {
    const Vec3 d = from->position_m[i] - 0.5 * block.size_m;
    const Vec3 expected = Vec3(d.z(), d.y(), -d.x()) + 0.5 * spec.size_m;
    for (const Vec3& x : cut->position_m) found += (x - expected).norm() < 1e-12;
  }
  REQUIRE(found == cut->radius_m.size());
}
