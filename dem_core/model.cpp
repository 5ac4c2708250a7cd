// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem_core/mesh.hpp"

namespace tilth {
namespace {

void check_lane(const LaneLaw& law, std::size_t lane, std::vector<std::string>& found) {
  const auto require = [&](bool ok, const char* name, double value, const char* range) {
    if (!ok) found.push_back(fmt::format("lane {}: {} = {}: must be {}", lane, name, value, range));
  };
  const auto finite_from_zero = [](double x) { return std::isfinite(x) && x >= 0; };
  require(finite_from_zero(law.contact_stiffness), "contact_stiffness", law.contact_stiffness,
          "finite and >= 0");
  require(std::isfinite(law.shear_stiffness_ratio) && law.shear_stiffness_ratio > 0,
          "shear_stiffness_ratio", law.shear_stiffness_ratio, "> 0");
  require(finite_from_zero(law.friction), "friction", law.friction, "finite and >= 0");
  require(finite_from_zero(law.wall_friction), "wall_friction", law.wall_friction,
          "finite and >= 0");
  require(finite_from_zero(law.rolling_friction), "rolling_friction", law.rolling_friction,
          "finite and >= 0");
  require(finite_from_zero(law.tool_friction), "tool_friction", law.tool_friction,
          "finite and >= 0");
  require(finite_from_zero(law.normal_damping), "normal_damping", law.normal_damping,
          "finite and >= 0");
  require(finite_from_zero(law.tangential_damping), "tangential_damping", law.tangential_damping,
          "finite and >= 0");
  const BondLaw& b = law.bond;
  for (const double x : {b.normal_scale, b.shear_scale, b.bending_scale, b.twisting_scale,
                         b.tensile_limit, b.cohesion_limit, b.tan_friction, b.bending_in_tension,
                         b.twisting_in_shear})
    require(finite_from_zero(x), "a constant of bond", x, "finite and >= 0");
  require(law.local_damping >= 0 && law.local_damping < 1, "local_damping", law.local_damping,
          "in [0, 1)");
  require(std::isfinite(law.dt_s) && law.dt_s > 0, "dt_s", law.dt_s, "> 0");
  for (const std::string& sentence : problems(law.effects))
    found.push_back(fmt::format("lane {}: {}", lane, sentence));
}

}  // namespace

std::vector<std::string> problems(const Model& model) {
  std::vector<std::string> found;
  const int lanes = model.num_lanes();
  if (lanes != 1 && lanes != 4 && lanes != 8)
    found.push_back(fmt::format("num_lanes = {}: must be 1, 4 or 8", lanes));
  for (std::size_t k = 0; k < model.lanes.size(); ++k) check_lane(model.lanes[k], k, found);
  if (model.num_fixed < 0 || model.num_fixed > model.num_particles())
    found.push_back(fmt::format("num_fixed = {}: must be in [0, {}]", model.num_fixed,
                                model.num_particles()));
  if (model.mass_kg.size() != model.radius_m.size())
    found.push_back(fmt::format("{} masses for {} radii", model.mass_kg.size(),
                                model.radius_m.size()));
  const auto bad = [](double x) { return !(std::isfinite(x) && x > 0); };
  if (std::ranges::any_of(model.radius_m, bad)) found.push_back("a radius_m is not positive");
  if (std::ranges::any_of(model.mass_kg, bad)) found.push_back("a mass_kg is not positive");
  const int n = model.num_particles();
  for (const BondGeometry& b : model.bonds)
    if (b.i < 0 || b.i >= b.j || b.j >= n) {
      found.push_back(fmt::format("bond ({}, {}): needs 0 <= i < j < {}", b.i, b.j, n));
      break;
    }
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    if (!(std::abs(model.walls[w].direction.norm() - 1) < 1e-9))
      found.push_back(fmt::format("wall {}: direction must be a unit vector", w));
  if (!model.bond_strength.empty()) {
    if (model.bond_strength.size() != model.bonds.size() * model.lanes.size())
      found.push_back(fmt::format("{} bond strengths for {} bonds in {} lanes",
                                  model.bond_strength.size(), model.bonds.size(), lanes));
    if (std::ranges::any_of(model.bond_strength, bad)) found.push_back("a bond_strength is not positive");
  }
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    if (const double scale = model.walls[w].adhesion_scale; !(std::isfinite(scale) && scale >= 0))
      found.push_back(fmt::format("wall {}: adhesion_scale = {}: must be finite and >= 0", w, scale));
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    if (const double scale = model.walls[w].friction_scale; !(std::isfinite(scale) && scale >= 0))
      found.push_back(fmt::format("wall {}: friction_scale = {}: must be finite and >= 0", w, scale));
  for (std::size_t t = 0; t < model.tools.size(); ++t) {
    for (const std::string& sentence : problems(model.tools[t].mesh))
      found.push_back(fmt::format("tool {}: {}", t, sentence));
    if (!(model.tools[t].max_depth_m >= 0))
      found.push_back(fmt::format("tool {}: max_depth_m must be >= 0", t));
  }
  const auto before = [](const auto& a, const auto& b) {
    return a.i != b.i ? a.i < b.i : a.j < b.j;
  };
  const auto out_of_order = [&](const auto& pairs) {  // or twice the same
    const auto wrong = [&](const auto& a, const auto& b) { return !before(a, b); };
    return std::ranges::adjacent_find(pairs, wrong) != pairs.end();
  };
  if (out_of_order(model.bonds)) found.push_back("bonds are not sorted by (i, j), each pair once");
  if (out_of_order(model.references))
    found.push_back("references are not sorted by (i, j), each pair once");
  return found;
}

double rolling_radius_m(const Model& model, int i, int j) {
  const double ri = model.radius_m[static_cast<std::size_t>(i)];
  const double rj = model.radius_m[static_cast<std::size_t>(j)];
  return ri * rj / (ri + rj);
}

std::vector<double> sphere_masses_kg(const std::vector<double>& radius_m,
                                     double density_kg_per_m3) {
  std::vector<double> mass_kg(radius_m.size());
  std::ranges::transform(radius_m, mass_kg.begin(), [=](double r) {
    return 4.0 / 3.0 * std::numbers::pi * r * r * r * density_kg_per_m3;
  });
  return mass_kg;
}

double damping_number(double restitution) {
  const double log_e = std::log(restitution);
  return -2 * log_e / std::sqrt(std::numbers::pi * std::numbers::pi + log_e * log_e);
}

}  // namespace tilth
