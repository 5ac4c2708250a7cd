// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Lanes are parameter sets advanced together: every lane has the bits of the same set run alone.
#include <catch2/catch.hpp>
#include <numbers>

#include "dem_core/packing.hpp"
#include "experiments/tool_shapes.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using tilth::testing::BondedCylinder;
using tilth::testing::Scene;

namespace {

/// True where the processor has the instructions; says so otherwise.
bool can_run(int num_lanes) {
  if (lanes_supported(num_lanes)) return true;
  WARN("skipped: this processor cannot run " << num_lanes << " lanes");
  return false;
}

/// The doubles of one lane out of a block of packs.
std::vector<double> one_lane(const AlignedDoubles& block, int num_lanes, int lane) {
  std::vector<double> out;
  for (auto k = static_cast<std::size_t>(lane); k < block.size();
       k += static_cast<std::size_t>(num_lanes))
    out.push_back(block[k]);
  return out;
}

void check_lane_equals_alone(const State& together, int lane, const State& alone) {
  CAPTURE(together.num_lanes, lane);
  const auto same = [&](const AlignedDoubles& a, const AlignedDoubles& b) {
    return one_lane(a, together.num_lanes, lane) == one_lane(b, 1, 0);
  };
  // determinism: every bit
  CHECK(same(together.motion, alone.motion));
  CHECK(same(together.bonds, alone.bonds));
  CHECK(same(together.walls, alone.walls));
  CHECK(same(together.wall_force, alone.wall_force));
  CHECK(same(together.tools, alone.tools));
  CHECK(same(together.tool_load, alone.tool_load));
  CHECK(together.time_s[static_cast<std::size_t>(lane)] == alone.time_s[0]);
  CHECK(together.active[static_cast<std::size_t>(lane)] == alone.active[0]);
}

/// Parameter set k of 8: every number of the cylinder within +-30 %, another time step each.
LaneLaw member(LaneLaw law, int k) {
  std::mt19937_64 rng(static_cast<unsigned>(k));
  const auto vary = [&rng](double& x) { x *= 0.7 + 0.6 * uniform01(rng); };
  for (double* x : {&law.contact_stiffness, &law.shear_stiffness_ratio, &law.friction,
                    &law.local_damping, &law.bond.normal_scale, &law.bond.shear_scale,
                    &law.bond.bending_scale, &law.bond.twisting_scale, &law.bond.tensile_limit,
                    &law.bond.cohesion_limit, &law.bond.tan_friction})
    vary(*x);
  law.bond.bending_in_tension = law.bond.twisting_in_shear = k % 2 ? 0.0 : 1.0;
  law.dt_s *= 1 - 0.03 * k;
  return law;
}

/// Sets 0 and 4 have no effect: alone they run the baseline's kernel, beside the others that of effects.
/// `stress_Pa` is one of the scene's scale.
EffectLaw effects_of(int k, double stress_Pa) {
  EffectLaw e;
  if (k % 4 == 0) return e;
  e.bond_softening = k == 1 || k == 6 ? 1.5 : 0.0;
  e.rate_strengthening = k >= 2 ? 0.1 * k : 0.0;
  e.rate_reference_per_s = 1e-3 * k;
  e.capillary_Pa = k == 2 || k == 7 ? stress_Pa : 0.0;
  e.healing_Pa = k == 3 ? stress_Pa : 0.0;
  e.healing_time_s = 0.3;
  e.tool_adhesion_Pa = k % 2 ? 0.2 * k * stress_Pa : 0.0;
  e.stiffness_exponent = k == 5 || k == 6 ? 0.06 * k : 0.0;
  e.reference_pressure_Pa = 3 * stress_Pa;
  e.contact_plasticity = k == 1 || k == 6 ? 0.1 * k : 0.0;
  e.crushing_compliance_per_Pa = k == 7 ? 1 / (20 * stress_Pa) : 0.0;
  return e;
}

/// Strengths from bond to bond, alike in every scene; none where only sets without effects run.
void add_bond_strengths(Scene& scene, const std::vector<int>& members) {
  if (members == std::vector<int>{0} || members == std::vector<int>{4}) return;
  for (std::size_t b = 0; b < scene.model.bonds.size(); ++b)
    for (const int k : members)
      scene.model.bond_strength.push_back(k % 4 == 0 ? 1.0 : 0.7 + 0.06 * static_cast<double>((b * 7 + static_cast<unsigned>(k)) % 11));
}

/// The cylinder crushed eight times as fast as the reference and at 40 % of its strength, so that
/// it fails within 1500 steps; set 5 diverges.
Scene crushed_cylinder(const std::vector<int>& members, bool with_effects = false) {
  Scene scene = testing::bonded_cylinder(static_cast<int>(members.size()));
  scene.law().bond.tensile_limit = 400;
  scene.law().bond.cohesion_limit = 200;
  const LaneLaw base = scene.law();
  for (std::size_t lane = 0; lane < members.size(); ++lane) {
    LaneLaw& law = scene.model.lanes[lane];
    law = member(base, members[lane]);
    if (members[lane] == 5) law.dt_s *= 20;
    if (with_effects) law.effects = effects_of(members[lane], 100);
  }
  if (with_effects) add_bond_strengths(scene, members);
  scene.begin();
  for (std::size_t lane = 0; lane < members.size(); ++lane)
    scene.state.drive(1, static_cast<int>(lane)).velocity_m_per_s = {
        0, 0, -8 * BondedCylinder::strain_rate_per_s * BondedCylinder::height_m};
  scene.run(1500);
  return scene;
}

/// Grains between plates held at a pressure of their own in each lane, sheared by a moving floor and,
/// where asked for, stirred by a cone and a vane that move on their own ways in each lane.
Scene pressed_packing(const std::vector<int>& members, bool stirred = false,
                      bool with_effects = false) {
  Scene scene;
  PackingSpec spec;
  spec.shape = ContainerShape::box;
  spec.size_m = {10, 10, 10};
  spec.num_particles = 120;
  spec.porosity = 0.45;
  const Packing packing = make_packing(spec);
  for (std::size_t i = 0; i < packing.radius_m.size(); ++i)
    scene.sphere(packing.position_m[i], packing.radius_m[i]);
  scene.model.mass_kg = sphere_masses_kg(scene.model.radius_m, 1.0);
  for (int axis = 0; axis < 2; ++axis) {
    scene.plane(Vec3::Unit(axis));
    scene.plane(-Vec3::Unit(axis), Vec3::Constant(10));
  }
  const int floor = scene.plane(Vec3::UnitZ());
  const int lid = scene.plane(-Vec3::UnitZ(), Vec3::Constant(10));
  Wall tube;
  tube.shape = WallShape::cylinder;
  tube.position_m = {5, 5, 0};
  tube.radius_m = 6;
  scene.model.walls.push_back(tube);
  scene.law().normal_damping = 0.3;
  scene.law().tangential_damping = 0.1;
  scene.law().dt_s = 2e-3;
  scene.model.gravity_m_per_s2 = {0, 0, -1};
  scene.set_num_lanes(static_cast<int>(members.size()));
  for (std::size_t lane = 0; lane < members.size(); ++lane) {
    LaneLaw& law = scene.model.lanes[lane];
    law.friction = 0.1 + 0.1 * members[lane];
    law.wall_friction = 0.5 - 0.05 * members[lane];
    law.contact_stiffness *= 1 + 0.1 * members[lane];
    if (with_effects) law.effects = effects_of(members[lane], 3);
    if (with_effects && members[lane] == 1) law.rolling_friction = 0.2;
  }
  if (with_effects) scene.model.walls[0].adhesion_scale = 0.5;
  if (stirred)
    scene.model.tools = {{.mesh = cone_mesh(1.0, 3, 2, 6, 9), .position_m = {3, 3, 9}},
                         {.mesh = vane_mesh(5, 3, 0.2), .position_m = {6, 6, 12}}};
  scene.begin();
  for (std::size_t lane = 0; stirred && lane < members.size(); ++lane) {
    scene.model.lanes[lane].tool_friction = 0.1 * members[lane];
    const double v = 0.6 + 0.1 * members[lane];
    scene.state.tool_drive(0, static_cast<int>(lane)).velocity_m_per_s = {0, 0, -v};
    scene.state.tool_drive(1, static_cast<int>(lane)) = {{0, 0, -2 * v}, {0.1 * v, 0, 2 * v}};
  }
  for (std::size_t lane = 0; lane < members.size(); ++lane) {
    WallDrive& servo = scene.state.drive(lid, static_cast<int>(lane));
    servo.servo_gain_m_per_N_s = 1e-3;
    servo.target_force_N = 100.0 + 50 * members[lane];
    servo.max_speed_m_per_s = 0.3;
    scene.state.drive(floor, static_cast<int>(lane)).velocity_m_per_s = {0.2, 0, 0};
  }
  scene.run(1500);
  return scene;
}

template <typename Run>
void check_all_lane_counts(Run run) {
  std::vector<Scene> alone;
  for (int k = 0; k < 8; ++k) alone.push_back(run(std::vector<int>{k}));
  for (const int w : {4, 8}) {
    if (!can_run(w)) continue;
    for (int first = 0; first < 8; first += w) {
      std::vector<int> members;
      for (int k = 0; k < w; ++k) members.push_back(first + k);
      const Scene together = run(members);
      for (int lane = 0; lane < w; ++lane)
        check_lane_equals_alone(together.state, lane,
                                alone[static_cast<std::size_t>(first + lane)].state);
    }
  }
}

}  // namespace

TEST_CASE("lanes: a crushed cylinder has the same bits alone, in fours and in eights",
          "[dem_core][lanes]") {
  std::vector<int> broken;
  check_all_lane_counts([&](const std::vector<int>& members) {
    Scene scene = crushed_cylinder(members);
    if (members.size() == 1) {
      broken.push_back(static_cast<int>(scene.model.bonds.size()) -
                       num_bonds_held(scene.model, scene.state));
      // set 5 ran away and was frozen; the others must not notice
      CHECK(scene.state.active[0] == (members[0] == 5 ? 0 : 1));
    }
    return scene;
  });
  CAPTURE(broken);
  // past the peak: at least 2 % of 3882 bonds are gone in every set that ran
  for (int k = 0; k < 8; ++k)
    if (k != 5) CHECK(broken[static_cast<std::size_t>(k)] > 80);
}

TEST_CASE("lanes: servo plates, moving walls and slipping grains have the same bits in any width",
          "[dem_core][lanes]") {
  check_all_lane_counts([](const auto& members) { return pressed_packing(members); });
}

TEST_CASE("lanes: cones and vanes stirring grains have the same bits in any width",
          "[dem_core][lanes][tools]") {
  check_all_lane_counts([](const std::vector<int>& members) {
    Scene scene = pressed_packing(members, true);
    for (int lane = 0; lane < scene.state.num_lanes; ++lane)
      for (const int tool : {0, 1}) CHECK(scene.state.num_tool_contacts(tool, lane) > 3);
    return scene;
  });
}

TEST_CASE("lanes: effects of its own leave a lane its bits in any width, and a lane without them the "
          "baseline's",
          "[dem_core][lanes][effects]") {
  check_all_lane_counts([](const auto& members) { return crushed_cylinder(members, true); });
  check_all_lane_counts([](const auto& members) { return pressed_packing(members, true, true); });
}

TEST_CASE("lanes: effects move something in every set that has them", "[dem_core][lanes][effects]") {
  for (int k = 0; k < 8; ++k) {
    const Scene with = pressed_packing({k}, true, true);
    const Scene without = pressed_packing({k}, true);
    CAPTURE(k);
    CHECK((with.state.motion == without.state.motion) == (k % 4 == 0));
  }
}

TEST_CASE("lanes: a lane frozen by hand stands still and the others do not notice",
          "[dem_core][lanes]") {
  if (!can_run(4)) return;
  const std::vector<int> members = {0, 1, 2, 3};
  Scene all = pressed_packing(members, true);
  Scene some = pressed_packing(members, true);
  some.state.active[1] = 0;
  model_changed(some.workspace);
  const std::vector<double> motion = one_lane(some.state.motion, 4, 1);
  const std::vector<double> force = one_lane(some.state.wall_force, 4, 1);
  const std::vector<double> tool_load = one_lane(some.state.tool_load, 4, 1);
  const std::vector<double> tools = one_lane(some.state.tools, 4, 1);
  const double time_s = some.state.time_s[1];
  all.run(500);
  some.run(500);
  CHECK(one_lane(some.state.motion, 4, 1) == motion);
  CHECK(one_lane(some.state.wall_force, 4, 1) == force);
  CHECK(one_lane(some.state.tool_load, 4, 1) == tool_load);
  CHECK(one_lane(some.state.tools, 4, 1) == tools);
  CHECK(some.state.time_s[1] == time_s);
  for (const int lane : {0, 2, 3}) {
    CHECK(one_lane(some.state.motion, 4, lane) == one_lane(all.state.motion, 4, lane));
    CHECK(one_lane(some.state.wall_force, 4, lane) == one_lane(all.state.wall_force, 4, lane));
    CHECK(one_lane(some.state.tool_load, 4, lane) == one_lane(all.state.tool_load, 4, lane));
  }
}

TEST_CASE("lanes: the widest lane count is one that runs, and one lane always does",
          "[dem_core][lanes]") {
  CHECK(lanes_supported(1));
  CHECK(lanes_supported(widest_lanes()));
  for (const int w : {-1, 0, 2, 3, 5, 16}) CHECK_FALSE(lanes_supported(w));
  // whatever this processor is wider than, it falls back to
  for (const int w : {1, 4, 8}) CHECK(lanes_supported(w) == (w <= widest_lanes()));
}

TEST_CASE("lanes: asking for more lanes than the processor has is refused", "[dem_core][lanes]") {
  Scene scene;
  scene.sphere({0, 0, 0});
  scene.set_num_lanes(2);
  CHECK_FALSE(problems(scene.model).empty());
  scene.state = initial_state(scene.model, scene.start_m);
  CHECK_THROWS_AS(step(scene.model, scene.state, scene.workspace), std::invalid_argument);
}
