// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "dem_core/neighbours.hpp"
#include "dem_core/step.hpp"
#include "dem_core/tool_geometry.hpp"

namespace tilth {
namespace {

std::size_t as_size(int k) { return static_cast<std::size_t>(k); }

std::vector<double> draw_radii(const PackingSpec& spec, std::mt19937_64& rng) {
  std::vector<double> radius(as_size(spec.num_particles));
  double volume = 0.0;
  for (double& r : radius) {
    r = 1 + spec.size_spread * (2 * uniform01(rng) - 1);
    volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  }
  const double scale = std::cbrt((1 - spec.porosity) * container_volume_m3(spec) / volume);
  for (double& r : radius) r *= scale;
  return radius;
}

Vec3 draw_point(const PackingSpec& spec, std::mt19937_64& rng, double margin_m) {
  const auto within = [&](double length) {
    return margin_m + uniform01(rng) * (length - 2 * margin_m);
  };
  if (spec.shape == ContainerShape::box) {
    const double x = within(spec.size_m.x());
    const double y = within(spec.size_m.y());
    return {x, y, within(spec.size_m.z())};
  }
  const double r = (spec.radius_m - margin_m) * std::sqrt(uniform01(rng));
  const double angle = 2 * std::numbers::pi * uniform01(rng);
  return {r * std::cos(angle), r * std::sin(angle), within(spec.size_m.z())};
}

std::vector<Wall> container_walls(const PackingSpec& spec) {
  std::vector<Wall> walls;
  const int first_axis = spec.shape == ContainerShape::box ? 0 : 2;
  for (int axis = first_axis; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      Wall wall;
      wall.direction = side * Vec3::Unit(axis);
      if (side < 0) wall.position_m = spec.size_m[axis] * Vec3::Unit(axis);
      walls.push_back(wall);
    }
  if (spec.shape == ContainerShape::cylinder) {
    Wall wall;
    wall.shape = WallShape::cylinder;
    wall.radius_m = spec.radius_m;
    walls.push_back(wall);
  }
  return walls;
}

/// Frictionless spheres of unit modulus and density: only ratios matter here.
Model relaxation_model(const PackingSpec& spec, const std::vector<double>& radius_m,
                       double mean_radius_m) {
  Model model;
  model.radius_m = radius_m;
  model.mass_kg = sphere_masses_kg(radius_m, 1.0);
  model.walls = container_walls(spec);
  LaneLaw law;
  law.contact_stiffness = 1.0;
  law.friction = 0.0;
  law.normal_damping = damping_number(0.2);
  law.local_damping = 0.1;
  // omega^2 of a grain with a dozen contacts of pi r / 2 each: well under 40 / (4/3 pi r^3) x r.
  law.dt_s = 0.15 * mean_radius_m * (1 - spec.size_spread);
  model.lanes = {law};
  return model;
}

void resize(Model& model, const std::vector<double>& final_radius_m, double scale) {
  for (std::size_t i = 0; i < final_radius_m.size(); ++i)
    model.radius_m[i] = scale * final_radius_m[i];
  model.mass_kg = sphere_masses_kg(model.radius_m, 1.0);
}

/// Sum and largest of overlap over the smaller radius.
struct Overlaps {
  double sum = 0.0;
  double largest = 0.0;
};

Overlaps overlaps(const Model& model, const State& state) {
  Overlaps found;
  for (const ReferenceDistance& p : pairs_within(model, state, 0.0)) {
    const double ri = model.radius_m[as_size(p.i)];
    const double rj = model.radius_m[as_size(p.j)];
    const double ratio = (ri + rj - p.distance_m) / std::min(ri, rj);
    found.sum += ratio;
    found.largest = std::max(found.largest, ratio);
  }
  return found;
}

void run(Model& model, State& state, Workspace& workspace, int num_steps) {
  for (int n = 0; n < num_steps; ++n) step(model, state, workspace);
}

/// Steps until the overlaps are gone or stop falling.
Overlaps relax(Model& model, State& state, Workspace& workspace) {
  Overlaps before = overlaps(model, state);
  for (int k = 0; k < 60 && before.largest > 1e-3; ++k) {
    run(model, state, workspace, 200);
    const Overlaps after = overlaps(model, state);
    const bool stalled = after.sum > 0.995 * before.sum && k > 10;
    before = after;
    if (stalled) break;
  }
  return before;
}

/// The grains of a state in spatial order.
Packing ordered(const State& state, const std::vector<double>& radius_m, double mean_radius_m,
                double largest_overlap) {
  Packing packing;
  packing.mean_radius_m = mean_radius_m;
  packing.largest_overlap = largest_overlap;
  std::vector<Vec3> position_m(radius_m.size());
  for (std::size_t i = 0; i < position_m.size(); ++i)
    position_m[i] = state.position_m(static_cast<int>(i));
  for (const int i : spatial_order(position_m, 2.5 * mean_radius_m)) {
    packing.radius_m.push_back(radius_m[as_size(i)]);
    packing.position_m.push_back(position_m[as_size(i)]);
  }
  return packing;
}

double mean_of(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

bool clear_of(const Tool& tool, const MeshFeatures& mesh, const Vec3& centre_m, double radius_m) {
  return tool_distance_m(tool, mesh, centre_m, 0.2 * radius_m) >= 0.2 * radius_m;
}

}  // namespace

double uniform01(std::mt19937_64& rng) { return static_cast<double>(rng() >> 11) * 0x1p-53; }

double container_volume_m3(const PackingSpec& spec) {
  if (spec.shape == ContainerShape::box) return spec.size_m.prod();
  return std::numbers::pi * spec.radius_m * spec.radius_m * spec.size_m.z();
}

std::vector<std::string> problems(const PackingSpec& spec) {
  std::vector<std::string> found;
  if (spec.num_particles < 10 || spec.num_particles > 1000000)
    found.push_back(fmt::format("num_particles = {}: must be in [10, 1000000]", spec.num_particles));
  if (!(spec.porosity > 0.3 && spec.porosity < 0.9))
    found.push_back(fmt::format("porosity = {}: must be in (0.3, 0.9)", spec.porosity));
  if (!(spec.size_spread >= 0 && spec.size_spread <= 0.6))
    found.push_back(fmt::format("size_spread = {}: must be in [0, 0.6]", spec.size_spread));
  if (!(spec.size_m.minCoeff() > 0) || !(spec.radius_m > 0))
    found.push_back("the container's size_m and radius_m must be positive");
  return found;
}

std::vector<int> spatial_order(const std::vector<Vec3>& position_m, double cell_m) {
  std::vector<int> order(position_m.size());
  std::iota(order.begin(), order.end(), 0);
  const auto cell = [&](int i, int axis) {
    return std::floor(position_m[as_size(i)][axis] / cell_m);
  };
  std::ranges::stable_sort(order, [&](int a, int b) {
    for (int axis = 2; axis >= 0; --axis)
      if (cell(a, axis) != cell(b, axis)) return cell(a, axis) < cell(b, axis);
    return false;
  });
  return order;
}

Packing make_packing(const PackingSpec& spec) {
  // 1. radii with the exact total volume, centres at random
  std::mt19937_64 rng(spec.seed);
  const std::vector<double> radius_m = draw_radii(spec, rng);
  const double mean_radius_m = mean_of(radius_m);
  constexpr double start_scale = 0.45;
  std::vector<Vec3> position_m(radius_m.size());
  for (std::size_t i = 0; i < radius_m.size(); ++i)
    position_m[i] = draw_point(spec, rng, start_scale * radius_m[i]);

  // 2. grow in small steps while the grains push each other apart
  Model model = relaxation_model(spec, radius_m, mean_radius_m);
  resize(model, radius_m, start_scale);
  State state = initial_state(model, position_m);
  Workspace workspace;
  constexpr int num_growths = 120;
  for (int k = 0; k <= num_growths; ++k) {
    resize(model, radius_m, start_scale + (1 - start_scale) * k / num_growths);
    model_changed(workspace);
    run(model, state, workspace, 20);
  }

  // 3. relax until the overlaps are gone or stop falling
  const Overlaps left = relax(model, state, workspace);

  // 4. store in spatial order
  return ordered(state, radius_m, mean_radius_m, left.largest);
}

Packing relaxed_packing(const PackingSpec& spec, const std::vector<double>& radius_m,
                        const std::vector<Vec3>& position_m) {
  const double mean_radius_m = mean_of(radius_m);
  Model model = relaxation_model(spec, radius_m, mean_radius_m);
  State state = initial_state(model, position_m);
  Workspace workspace;
  const Overlaps left = relax(model, state, workspace);
  return ordered(state, radius_m, mean_radius_m, left.largest);
}

Packing packing_around(const PackingSpec& spec, const Packing& packing,
                       const std::vector<Tool>& tools) {
  std::vector<double> radius_m;
  std::vector<Vec3> position_m;
  std::vector<MeshFeatures> meshes;
  for (const Tool& tool : tools) meshes.push_back(mesh_features(tool.mesh));
  for (std::size_t i = 0; i < packing.radius_m.size(); ++i) {
    bool clear = true;
    for (std::size_t t = 0; t < tools.size(); ++t)
      clear = clear && clear_of(tools[t], meshes[t], packing.position_m[i], packing.radius_m[i]);
    if (!clear) continue;
    radius_m.push_back(packing.radius_m[i]);
    position_m.push_back(packing.position_m[i]);
  }
  Model model = relaxation_model(spec, radius_m, packing.mean_radius_m);
  model.tools = tools;
  State state = initial_state(model, position_m);
  Workspace workspace;
  run(model, state, workspace, 1000);  // what the tools push aside is no overlap of grains yet
  const Overlaps left = relax(model, state, workspace);
  return ordered(state, radius_m, packing.mean_radius_m, left.largest);
}

}  // namespace tilth
