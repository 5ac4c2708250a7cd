// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Packs of lanes are a way to run members, never a part of the result.
#include <algorithm>

#include "experiments/drained_triaxial.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;

namespace {

using Batch = std::vector<ExperimentResult>;

struct NamedTest {
  const char* name;
  std::function<Batch(std::span<const SoilMaterial>, const RunOptions&)> run;
};

/// Every test, small and fast; the shear test at two of its normal stresses.
/// Every test, small and fast: compression at two rates, shear tests at two of their normal stresses
/// and one of them on a cut block, the oedometer with both loops.
/// The tests, small and fast; the shear test at two of its normal stresses.
std::vector<NamedTest> small_tests() {
  return {{"unconfined compression",
           [](auto members, const RunOptions& o) {
             UnconfinedCompressionConfig c = small_unconfined();
             c.fast_rate_ratio = 3;
             return run_unconfined_compression(members, c, packings(), o);
           }},
          {"direct tension",
           [](auto members, const RunOptions& o) {
             return run_direct_tension(members, small_tension(), packings(), o);
           }},
          {"interface shear",
           [](auto members, const RunOptions& o) {
             return run_interface_shear(members, small_interface(), packings(), o);
           }},
          {"direct shear of a cut block",
           [](auto members, const RunOptions& o) {
             DirectShearConfig c = small_shear();
             c.normal_stress_Pa = {20e3};
             c.cut_angle_rad = 0.5;
             return run_direct_shear(members, c, packings(), o);
           }},
          {"direct shear",
           [](auto members, const RunOptions& o) {
             DirectShearConfig c = small_shear();
             c.normal_stress_Pa = {10e3, 40e3};
             return run_direct_shear(members, c, packings(), o);
           }},
          {"drained triaxial",
           [](auto members, const RunOptions& o) {
             DrainedTriaxialConfig c{.num_particles = 100,
                                     .cell_pressure_Pa = {2e3, 4e3},
                                     .relative_density = {0.0, 0.0},
                                     .inertial_number = 4e-3,
                                     .max_axial_strain = 0.08};
             return run_drained_triaxial(members, c, packings(), o);
           }},
          {"confined compression", [](auto members, const RunOptions& o) {
             ConfinedCompressionConfig c = small_confined();
             c.second_load_to_stress_Pa = 150e3;
             return run_confined_compression(members, c, packings(), o);
             return run_confined_compression(members, small_confined(), packings(), o);
           }},
          {"cone penetration",
           [](auto members, const RunOptions& o) {
             return run_cone_penetration(members, tiny_cone(), packings(), o);
           }},
          {"vane shear", [](auto members, const RunOptions& o) {
             return run_vane_shear(members, tiny_vane(), packings(), o);
           }}};
}

std::vector<SoilMaterial> soils_of_two_densities() {
  std::vector<SoilMaterial> soils = eight_soils();
  soils[2].density_kg_per_m3 = soils[5].density_kg_per_m3 = 1900;
  return soils;
}

}  // namespace

TEST_CASE("Experiments: packs of 8 and of 4 give every member the bits of its own single run",
          "[experiments][packs]") {
  // On a processor without such lanes the pack falls back to what there is.
  for (const NamedTest& test : small_tests()) {
    const Batch single = test.run(eight_soils(), with_lanes(1));
    for (const ExperimentResult& r : single) REQUIRE(r.status == RunStatus::completed);
    for (const int lanes : {4, 8}) {
      INFO(test.name << ", " << lanes << " lanes");
      require_same(test.run(eight_soils(), with_lanes(lanes)), single);
    }
  }
}

TEST_CASE("Experiments: neither the order of the members nor their number changes a member",
          "[experiments][packs]") {
  // Two densities, so that packs are cut across the order, and a pack of six with two spare lanes.
  const std::vector<SoilMaterial> soils = soils_of_two_densities();
  std::vector<SoilMaterial> reversed(soils.rbegin(), soils.rend());
  for (const NamedTest& test : small_tests()) {
    INFO(test.name);
    const Batch forward = test.run(soils, {});
    Batch backward = test.run(reversed, {});
    std::ranges::reverse(backward);
    require_same(backward, forward);
    const Batch three = test.run(std::span(soils).subspan(3, 3), {});
    require_same(three, Batch(forward.begin() + 3, forward.begin() + 6));
  }
}

TEST_CASE("Experiments: packs may run in any order", "[experiments][packs]") {
  const std::vector<SoilMaterial> soils = soils_of_two_densities();
  RunOptions backwards = with_lanes(4);
  std::size_t num_packs = 0;
  backwards.for_each = [&](std::size_t n, const std::function<void(std::size_t)>& body) {
    num_packs = n;
    for (std::size_t k = n; k-- > 0;) body(k);
  };
  for (const NamedTest& test : small_tests()) {
    INFO(test.name);
    require_same(test.run(soils, backwards), test.run(soils, with_lanes(4)));
    REQUIRE(num_packs >= 3);
  }
}

TEST_CASE("Experiments: a member's time step depends on that member alone",
          "[experiments][packs]") {
  std::vector<SoilMaterial> soils = eight_soils();
  const auto run = [](std::span<const SoilMaterial> members) {
    UnconfinedCompressionConfig c = small_unconfined(1e-2);
    c.max_axial_strain = 2e-3;
    return run_unconfined_compression(members, c, packings());
  };
  const Batch before = run(soils);
  soils[0].contact_modulus_Pa = 1e9;  // (1e9 + 1e6) / 2e6: a step some 22 times shorter
  const Batch after = run(soils);
  REQUIRE(after[0].dt_s < 0.2 * before[0].dt_s);
  for (std::size_t k = 1; k < soils.size(); ++k) REQUIRE(after[k].dt_s == before[k].dt_s);
  // The bound goes with sqrt(m / k): a quarter of the modulus, twice the step, exactly.
  SoilMaterial softer = bonded_soil(1e6);
  REQUIRE(run({&softer, 1}).front().dt_s == 2 * run(std::vector{bonded_soil(4e6)}).front().dt_s);
}

TEST_CASE("Packs: widths cover the members with as few and as full packs as the processor allows",
          "[experiments][packs]") {
  using Widths = std::vector<int>;
  REQUIRE(pack_widths(0, 8) == Widths{});
  REQUIRE(pack_widths(1, 8) == Widths{1});
  REQUIRE(pack_widths(2, 8) == Widths{4});
  REQUIRE(pack_widths(4, 8) == Widths{4});
  REQUIRE(pack_widths(5, 8) == Widths{8});
  REQUIRE(pack_widths(8, 8) == Widths{8});
  REQUIRE(pack_widths(9, 8) == Widths{8, 1});
  REQUIRE(pack_widths(19, 8) == Widths{8, 8, 4});
  REQUIRE(pack_widths(9, 4) == Widths{4, 4, 1});
  REQUIRE(pack_widths(3, 1) == Widths{1, 1, 1});
}

TEST_CASE("Packs: every task is run once, beside tasks of its own density only",
          "[experiments][packs]") {
  const std::vector<double> density = {2, 1, 2, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2};
  std::vector<int> times_run(density.size(), 0);
  const auto run = [&](std::span<const std::size_t> task_of_lane) {
    Batch pack;
    for (std::size_t lane = 0; lane < task_of_lane.size(); ++lane) {
      const std::size_t task = task_of_lane[lane];
      REQUIRE(density[task] == density[task_of_lane[0]]);
      if (lane == 0 || task != task_of_lane[0]) ++times_run[task];  // spare lanes repeat the first
      pack.emplace_back().num_steps = static_cast<std::int64_t>(100 + task);
    }
    return pack;
  };
  for (const int lanes : {1, 4, 8}) {
    std::ranges::fill(times_run, 0);
    const Batch results = run_in_packs(density, with_lanes(lanes), run);
    for (std::size_t k = 0; k < density.size(); ++k) {
      REQUIRE(times_run[k] == 1);
      REQUIRE(results[k].num_steps == static_cast<std::int64_t>(100 + k));
    }
  }
  REQUIRE(run_in_packs({}, {}, run).empty());
}
