// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/scene.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "dem_core/packing.hpp"

namespace tilth::testing {

Scene::Scene() {
  model.stiffness_kind = StiffnessKind::per_contact;
  model.lanes.resize(1);
  law().contact_stiffness = 1e4;
  law().friction = 0.0;
  law().dt_s = 1e-4;
}

int Scene::sphere(const Vec3& position_m, double radius_m, double mass_kg) {
  start_m.push_back(position_m);
  model.radius_m.push_back(radius_m);
  model.mass_kg.push_back(mass_kg);
  return model.num_particles() - 1;
}

BondGeometry& Scene::bond(int i, int j) {
  const double length_m =
      (start_m[static_cast<std::size_t>(j)] - start_m[static_cast<std::size_t>(i)]).norm();
  model.bonds.push_back(bond_from_numbers(i, j, length_m));
  return model.bonds.back();
}

int Scene::plane(const Vec3& normal, const Vec3& point_m) {
  Wall wall;
  wall.direction = normal;
  wall.position_m = point_m;
  model.walls.push_back(wall);
  return static_cast<int>(model.walls.size()) - 1;
}

void Scene::set_num_lanes(int num_lanes) {
  const LaneLaw first = law();
  model.lanes.assign(static_cast<std::size_t>(num_lanes), first);
}

void Scene::begin() {
  REQUIRE(problems(model) == std::vector<std::string>{});
  state = initial_state(model, start_m);
  workspace = {};
}

void Scene::run(int num_steps) {
  for (int n = 0; n < num_steps; ++n) step(model, state, workspace);
}

std::vector<Vec3> scattered_points(int num_points, double size_m, double min_distance_m,
                                   unsigned seed) {
  std::mt19937_64 rng(seed);
  std::vector<Vec3> points;
  for (int attempt = 0; static_cast<int>(points.size()) < num_points; ++attempt) {
    REQUIRE(attempt < 1000000);  // no room for that many
    const double x = size_m * uniform01(rng);
    const double y = size_m * uniform01(rng);
    const Vec3 p(x, y, size_m * uniform01(rng));
    const auto near = [&](const Vec3& q) { return (p - q).norm() < min_distance_m; };
    if (std::ranges::none_of(points, near)) points.push_back(p);
  }
  return points;
}

void add_bonded_cluster(Scene& scene, const Vec3& centre_m, int num_grains, double reach_m,
                        unsigned seed) {
  std::mt19937_64 rng(seed);
  const int first = scene.model.num_particles();
  const double size_m = 1.9 * std::cbrt(num_grains);
  for (const Vec3& p : scattered_points(num_grains, size_m, 1.7, seed))
    scene.sphere(centre_m + p - Vec3::Constant(0.5 * size_m), 0.9 + 0.2 * uniform01(rng),
                 0.8 + 0.4 * uniform01(rng));
  for (int i = first; i < scene.model.num_particles(); ++i)
    for (int j = i + 1; j < scene.model.num_particles(); ++j)
      if ((scene.start_m[static_cast<std::size_t>(j)] - scene.start_m[static_cast<std::size_t>(i)])
              .norm() < reach_m)
        scene.bond(i, j);
}

std::vector<std::vector<double>> read_table(const std::string& file) {
  std::ifstream in(file);
  INFO("table " << file);
  REQUIRE(in);
  std::vector<std::vector<double>> rows;
  std::string line;
  bool names_seen = false;
  while (std::getline(in, line)) {
    if (line.starts_with('#')) continue;
    if (!std::exchange(names_seen, true)) continue;
    std::ranges::replace(line, ',', ' ');
    std::istringstream cells(line);
    std::vector<double>& row = rows.emplace_back();
    for (double value = 0; cells >> value;) row.push_back(value);
  }
  return rows;
}

Scene bonded_cylinder(int num_lanes) {
  const std::string folder = TILTH_SOURCE_DIR "/tests/reference/bonded_cylinder/";
  Scene scene;
  for (const auto& row : read_table(folder + "spheres.csv"))
    scene.sphere({row[0], row[1], row[2]}, row[3]);
  Model& model = scene.model;
  model.mass_kg = sphere_masses_kg(model.radius_m, 1.0);
  for (const auto& row : read_table(folder + "bonds.csv")) {
    const int i = static_cast<int>(row[0]);
    const int j = static_cast<int>(row[1]);
    model.bonds.push_back(bond_from_numbers(
        i, j,
        model.radius_m[static_cast<std::size_t>(i)] + model.radius_m[static_cast<std::size_t>(j)]));
  }
  LaneLaw& law = scene.law();
  law.contact_stiffness = 1e5;
  law.shear_stiffness_ratio = 0.4;
  law.friction = 0.5;
  law.local_damping = 0.3;
  law.dt_s = 5e-4;
  law.bond = {.normal_scale = 1e5,
              .shear_scale = 4e4,
              .bending_scale = 2.5e4,
              .twisting_scale = 2e4,
              .tensile_limit = 1000,
              .cohesion_limit = 500,
              .tan_friction = 0.5};
  model.damping_kind = DampingKind::rate;
  model.contact_beside_bond = false;
  scene.plane(Vec3::UnitZ());
  scene.plane(-Vec3::UnitZ(), {0, 0, BondedCylinder::height_m});
  scene.set_num_lanes(num_lanes);
  return scene;
}

double plate_stress_Pa(const State& state, int lane) {
  const double area_m2 = std::numbers::pi * BondedCylinder::radius_m * BondedCylinder::radius_m;
  return 0.5 * (state.wall_force_N(1, lane).z() - state.wall_force_N(0, lane).z()) / area_m2;
}

}  // namespace tilth::testing
