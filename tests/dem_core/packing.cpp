// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Random packings: what they promise for any specification (docs/theory/packing.md).
#include "dem_core/packing.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

using namespace tilth;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

PackingSpec small_cylinder(std::uint64_t seed = 1) {
  PackingSpec spec;
  spec.radius_m = 0.025;
  spec.size_m = {0, 0, 0.05};
  spec.size_m.head<2>().setConstant(0.05);
  spec.num_particles = 250;
  spec.porosity = 0.42;
  spec.seed = seed;
  return spec;
}

PackingSpec small_box(double porosity, double spread) {
  PackingSpec spec;
  spec.shape = ContainerShape::box;
  spec.size_m = {0.03, 0.04, 0.05};
  spec.num_particles = 250;
  spec.porosity = porosity;
  spec.size_spread = spread;
  return spec;
}

std::vector<PackingSpec> several() {
  return {small_cylinder(), small_box(0.38, 0.0), small_box(0.5, 0.6)};
}

/// How far a grain reaches out of the container, positive outside.
double reach_out_m(const PackingSpec& spec, const Vec3& x, double r) {
  double out = std::max(r - x.z(), x.z() + r - spec.size_m.z());
  if (spec.shape == ContainerShape::cylinder)
    return std::max(out, x.head<2>().norm() + r - spec.radius_m);
  for (int axis = 0; axis < 2; ++axis)
    out = std::max({out, r - x[axis], x[axis] + r - spec.size_m[axis]});
  return out;
}

}  // namespace

TEST_CASE("packing: the porosity is exact", "[dem_core][packing]") {
  for (const PackingSpec& spec : several()) {
    double solid_m3 = 0;
    for (const double r : make_packing(spec).radius_m)
      solid_m3 += 4.0 / 3 * std::numbers::pi * r * r * r;
    // 1e-13: a sum of 250 rounded volumes
    CHECK_THAT(1 - solid_m3 / container_volume_m3(spec), WithinRel(spec.porosity, 1e-13));
  }
}

TEST_CASE("packing: every grain is inside and no pair overlaps more than stated",
          "[dem_core][packing]") {
  for (const PackingSpec& spec : several()) {
    const Packing p = make_packing(spec);
    REQUIRE(p.radius_m.size() == 250);
    REQUIRE(p.position_m.size() == 250);
    double worst_wall = 0, worst_pair = 0;
    for (std::size_t i = 0; i < 250; ++i) {
      worst_wall =
          std::max(worst_wall, reach_out_m(spec, p.position_m[i], p.radius_m[i]) / p.radius_m[i]);
      for (std::size_t j = i + 1; j < 250; ++j) {
        const double overlap_m =
            p.radius_m[i] + p.radius_m[j] - (p.position_m[i] - p.position_m[j]).norm();
        worst_pair = std::max(worst_pair, overlap_m / std::min(p.radius_m[i], p.radius_m[j]));
      }
    }
    CAPTURE(spec.porosity, worst_wall, worst_pair);
    CHECK_THAT(worst_pair, WithinAbs(p.largest_overlap, 1e-12));
    // a wall contact is twice as stiff as a pair, so it gives way less
    CHECK(worst_wall <= p.largest_overlap + 1e-12);
    // 0.05: at these porosities what relaxation leaves; equal spheres at 0.38 between walls of
    // eight diameters keep 0.18, because there is no room
    if (spec.porosity > 0.4) CHECK(p.largest_overlap < 0.05);
  }
}

TEST_CASE("packing: radii are uniform within the spread", "[dem_core][packing]") {
  for (const double spread : {0.0, 0.25, 0.6}) {
    const Packing p = make_packing(small_box(0.5, spread));
    const auto [low, high] = std::ranges::minmax(p.radius_m);
    const double mean_m = std::accumulate(p.radius_m.begin(), p.radius_m.end(), 0.0) / 250;
    CAPTURE(spread);
    CHECK_THAT(p.mean_radius_m, WithinRel(mean_m, 1e-13));
    CHECK(high / low <= (1 + spread) / (1 - spread) * (1 + 1e-12));
    // standard deviation of a uniform distribution s / sqrt(3); 10 %: 250 samples, 2 standard
    // errors
    double variance = 0;
    for (const double r : p.radius_m) variance += (r / mean_m - 1) * (r / mean_m - 1) / 250;
    CHECK_THAT(std::sqrt(variance),
               WithinAbs(spread / std::sqrt(3), 0.1 * spread / std::sqrt(3) + 1e-12));
  }
}

TEST_CASE("packing: equal specifications give equal bits, another seed another packing",
          "[dem_core][packing]") {
  const Packing a = make_packing(small_cylinder(1));
  const Packing b = make_packing(small_cylinder(1));
  const Packing c = make_packing(small_cylinder(2));
  CHECK(a.radius_m == b.radius_m);
  CHECK(a.position_m == b.position_m);
  CHECK(a.radius_m != c.radius_m);
  CHECK(a.position_m != c.position_m);
}

TEST_CASE("packing: the generator is the same everywhere", "[dem_core][packing]") {
  std::mt19937_64 rng(5489);
  // 10 000th value of mt19937_64 (C++ standard, [rand.predef]) shifted to 53 bits
  for (int k = 0; k < 9999; ++k) rng();
  CHECK(uniform01(rng) == static_cast<double>(9981545732273789042ULL >> 11) * 0x1p-53);
}

TEST_CASE("packing: the spatial order keeps every grain once, by layers", "[dem_core][packing]") {
  const std::vector<Vec3> x = {{0.5, 0.5, 2.5}, {2.5, 0.5, 0.5}, {0.5, 2.5, 0.5}, {0.5, 0.5, 0.5}};
  CHECK(spatial_order(x, 1.0) == std::vector<int>{3, 1, 2, 0});
}

TEST_CASE("packing: every bad specification is named", "[dem_core][packing]") {
  CHECK(problems(PackingSpec{}).empty());
  const auto complaint = [](auto spoil) {
    PackingSpec spec;
    spoil(spec);
    const std::vector<std::string> found = problems(spec);
    return found.size() == 1 ? found[0] : std::to_string(found.size()) + " problems";
  };
  CHECK_THAT(complaint([](PackingSpec& s) { s.num_particles = 9; }), Contains("num_particles"));
  CHECK_THAT(complaint([](PackingSpec& s) { s.porosity = 0.3; }), Contains("porosity"));
  CHECK_THAT(complaint([](PackingSpec& s) { s.porosity = std::nan(""); }), Contains("porosity"));
  CHECK_THAT(complaint([](PackingSpec& s) { s.size_spread = 0.61; }), Contains("size_spread"));
  CHECK_THAT(complaint([](PackingSpec& s) { s.size_m.z() = 0; }), Contains("size_m"));
  CHECK_THAT(complaint([](PackingSpec& s) { s.radius_m = -1; }), Contains("radius_m"));
}
