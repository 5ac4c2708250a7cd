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

TEST_CASE("Cut block: the cut fills the box as its own packing does", "[experiments][cut]") {
  const auto own = packings().get(box(150));
  for (const double angle_rad : {0.3, std::numbers::pi / 2}) {
    const auto cut = cut_block(packings(), box(150), angle_rad);
    CAPTURE(angle_rad, cut->radius_m.size());
    // The last grain taken may go over by its volume, 1 / 150 on average.
    REQUIRE(solid_m3(*cut) >= solid_m3(*own) * (1 - 1e-12));
    REQUIRE_THAT(solid_m3(*cut), WithinRel(solid_m3(*own), 2.0 / 150));
    // 0.05: the mean of 150 radii of 14 % standard deviation is known to 1.2 %; one volume to share
    REQUIRE_THAT(cut->mean_radius_m, WithinRel(own->mean_radius_m, 0.05));
    // Pushed in by the walls: what sticks out is overlap, of the size that the own packing has.
    double out_m = 0;
    for (std::size_t i = 0; i < cut->radius_m.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const double x = cut->position_m[i][axis];
        out_m = std::max(out_m, cut->radius_m[i] - std::min(x, box(150).size_m[axis] - x));
      }
    REQUIRE(out_m < 0.3 * cut->mean_radius_m);
  }
}

TEST_CASE("Cut block: the block turns by the right hand about y, and the deepest grains stay",
          "[experiments][cut]") {
  // Block of 4 x 2 x 8 m turned by 90 degrees into a box of 6 x 2 x 2 m: z goes to x, x to -z.
  Packing block;
  block.radius_m = {0.1, 0.2, 0.3};
  block.position_m = {{2, 1, 6.5}, {2.5, 1.2, 4}, {2, 1, 7.9}};  // to x = 5.5, 3 and 6.9
  const auto cut_up_to = [&block](double volume_m3) {
    return cut_from(block, {4, 2, 8}, {6, 2, 2}, volume_m3, std::numbers::pi / 2);
  };
  const double two = solid_m3({.radius_m = {0.1, 0.2}, .position_m = {}});
  const Packing cut = cut_up_to(two * (1 - 1e-9));
  REQUIRE(cut.radius_m.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 expected = cut.radius_m[i] == 0.1 ? Vec3(5.5, 1, 1) : Vec3(3, 1.2, 0.5);
    REQUIRE((cut.position_m[i] - expected).norm() < 1e-12);
  }
  REQUIRE_THAT(cut.mean_radius_m, WithinRel(0.15, 1e-12));
  REQUIRE(cut_up_to(two * (1 + 1e-9)).radius_m.back() == 0.3);  // the one outside comes last
  REQUIRE(cut_up_to(1e9).radius_m.size() == 3);
}
