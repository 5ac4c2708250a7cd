// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Saving, loading and continuing.
#include "dem_core/snapshot.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <string_view>

#include "experiments/tool_shapes.hpp"
#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::Contains;
using tilth::testing::add_bonded_cluster;
using tilth::testing::Scene;

namespace {

/// A folder that goes away with the test.
struct TemporaryFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("tilth_snapshot_" + std::to_string(::getpid()));
  TemporaryFolder() { std::filesystem::create_directories(path); }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

/// Bonded clusters in a box under a servo plate: bonds break, grains slip.
Scene pressed_clusters() {
  Scene scene;
  scene.model.contact_beside_bond = false;
  scene.model.gravity_m_per_s2 = {0.5, 0, -5};
  LaneLaw& law = scene.law();
  law.friction = 0.4;
  law.wall_friction = 0.2;
  law.normal_damping = 0.3;
  law.dt_s = 1e-3;
  law.bond = {.normal_scale = 1e4,
              .shear_scale = 5e3,
              .bending_scale = 2e3,
              .twisting_scale = 1e3,
              .tensile_limit = 300,
              .cohesion_limit = 150,
              .tan_friction = 0.3,
              .bending_in_tension = 0.5,
              .twisting_in_shear = 0.5};
  add_bonded_cluster(scene, {0, 0, 3}, 12, 2.6, 1);
  add_bonded_cluster(scene, {0, 0, 8}, 12, 2.6, 2);
  for (int axis = 0; axis < 2; ++axis) {
    scene.plane(Vec3::Unit(axis), Vec3::Constant(-3.5));
    scene.plane(-Vec3::Unit(axis), Vec3::Constant(3.5));
  }
  scene.plane(Vec3::UnitZ());
  const int lid = scene.plane(-Vec3::UnitZ(), {0, 0, 12});
  scene.law().tool_friction = 0.3;
  scene.model.tools.push_back({.mesh = vane_mesh(4, 2, 0.3), .position_m = {0, 0, 6}});
  scene.begin();
  scene.state.tool_drive(0, 0) = {{0, 0, -0.5}, {0.2, 0, 1}};
  scene.state.drive(lid, 0) = {
      .servo_gain_m_per_N_s = 1e-2, .target_force_N = 300, .max_speed_m_per_s = 2};
  return scene;
}

bool same_bits(const State& a, const State& b) {
  return a.motion == b.motion && a.bonds == b.bonds && a.walls == b.walls &&
         a.wall_force == b.wall_force && a.tools == b.tools && a.tool_load == b.tool_load &&
         a.time_s == b.time_s && a.num_steps == b.num_steps &&
         a.active == b.active;
}

std::string read_all(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_all(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("snapshot: save, load, continue equals continue, bit for bit", "[dem_core][snapshot]") {
  const TemporaryFolder folder;
  Scene scene = pressed_clusters();
  const int bonds = num_bonds_held(scene.model, scene.state);
  scene.run(1500);
  REQUIRE(num_bonds_held(scene.model, scene.state) < bonds);
  REQUIRE(num_bonds_held(scene.model, scene.state) > 0);
  save_snapshot(scene.state, folder.path / "run.state");
  Scene copy = pressed_clusters();
  copy.state = load_snapshot(folder.path / "run.state");
  CHECK(same_bits(copy.state, scene.state));
  for (int n = 0; n < 1500; ++n) {
    scene.run(1);
    copy.run(1);
  }
  CHECK(same_bits(copy.state, scene.state));
  CHECK_FALSE(std::filesystem::exists(folder.path / "run.state.part"));
}

TEST_CASE("snapshot: the workspace can be thrown away at any time", "[dem_core][snapshot]") {
  Scene scene = pressed_clusters();
  Scene forgetful = pressed_clusters();
  for (int n = 0; n < 1000; ++n) {
    scene.run(1);
    forgetful.run(1);
    if (n % 7 == 0) forgetful.workspace = {};
  }
  CHECK(same_bits(scene.state, forgetful.state));
}

TEST_CASE("snapshot: damaged files are refused with their name", "[dem_core][snapshot]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "bad.state";
  Scene scene = pressed_clusters();
  scene.run(10);
  save_snapshot(scene.state, file);
  const std::string good = read_all(file);
  CHECK_THROWS_WITH(load_snapshot(folder.path / "absent.state"), Contains("absent.state"));
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{7}, std::size_t{21}, good.size() / 2, good.size() - 1}) {
    write_all(file, good.substr(0, length));
    CAPTURE(length);
    CHECK_THROWS_WITH(load_snapshot(file), Contains("bad.state"));
  }
  std::string foreign = good;
  foreign[0] = 'T';
  write_all(file, foreign);
  CHECK_THROWS_WITH(load_snapshot(file), Contains("not a tilth snapshot"));
  std::string absurd = good;
  const std::uint64_t count = scene.state.motion.size();
  const std::string_view count_bytes(reinterpret_cast<const char*>(&count), sizeof count);
  absurd.replace(absurd.find(count_bytes), sizeof count, sizeof count, '\xff');
  write_all(file, absurd);
  CHECK_THROWS_WITH(load_snapshot(file), Contains("damaged"));
  write_all(file, good + "x");
  CHECK_THROWS_WITH(load_snapshot(file), Contains("bad.state"));
}

TEST_CASE("snapshot: a folder that cannot be written is an error that names the file",
          "[dem_core][snapshot]") {
  CHECK_THROWS_WITH(save_snapshot(State{}, "/nonexistent_folder/run.state"),
                    Contains("/nonexistent_folder/run.state"));
}
