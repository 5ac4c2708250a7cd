// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/scale_groups.hpp"

#include <cmath>

namespace tilth {
namespace {

struct Formula {
  const char* kind;
  const char* name;
  const char* formula;
  double (*value)(const SweepTillageConfig&, const SoilMaterial&);
};

double overburden_Pa(const SweepTillageConfig& c) {
  return c.bulk_density_kg_per_m3 * c.gravity_m_per_s2 * c.tool_depth_m;
}

constexpr double inertial_factor = 2.0;  ///< diameter over radius

const Formula formulas[] = {
    {"geometric", "particle over tool", "2 r / B",
     [](const auto& c, const auto&) { return 2 * c.particle_radius_m / c.sweep.width_m; }},
    {"geometric", "particle over depth", "2 r / h",
     [](const auto& c, const auto&) { return 2 * c.particle_radius_m / c.tool_depth_m; }},
    {"geometric", "particle over tracer", "2 r / s",
     [](const auto& c, const auto&) { return 2 * c.particle_radius_m / c.tracer_size_m; }},
    {"geometric", "depth over width", "h / B",
     [](const auto& c, const auto&) { return c.tool_depth_m / c.sweep.width_m; }},
    {"geometric", "bin over width", "W / B",
     [](const auto& c, const auto&) { return c.bin_width_m / c.sweep.width_m; }},
    {"geometric", "size distribution", "half width of radii / r", [](const auto& c, const auto&) { return c.size_spread; }},
    {"geometric", "porosity of the spheres", "n", [](const auto& c, const auto&) { return c.porosity; }},
    {"geometric", "bond gap", "gap / r", [](const auto& c, const auto&) { return c.bond_gap_over_radius; }},
    {"kinematic", "Froude number", "v / sqrt(g h)",
     [](const auto& c, const auto&) { return c.speed_m_per_s / std::sqrt(c.gravity_m_per_s2 * c.tool_depth_m); }},
    {"kinematic", "inertial number", "(v / B) 2 r / sqrt(g h)",
     [](const auto& c, const auto&) {
       return c.speed_m_per_s / c.sweep.width_m * inertial_factor * c.particle_radius_m /
              std::sqrt(c.gravity_m_per_s2 * c.tool_depth_m);
     }},
    {"dynamic", "contact stiffness", "E_c / (rho g h)",
     [](const auto& c, const auto& m) { return m.contact_modulus_Pa / overburden_Pa(c); }},
    {"dynamic", "bond stiffness", "E_b / (rho g h)",
     [](const auto& c, const auto& m) { return m.bond.modulus_Pa / overburden_Pa(c); }},
    {"dynamic", "bond tensile strength", "sigma_t / (rho g h)",
     [](const auto& c, const auto& m) { return m.bond.tensile_strength_Pa / overburden_Pa(c); }},
    {"dynamic", "bond cohesion", "c / (rho g h)",
     [](const auto& c, const auto& m) { return m.bond.cohesion_Pa / overburden_Pa(c); }},
    {"dynamic", "friction", "mu", [](const auto&, const auto& m) { return m.friction; }},
    {"dynamic", "tool friction", "mu_tool", [](const auto&, const auto& m) { return m.tool_friction; }},
    {"dynamic", "restitution", "e", [](const auto& c, const auto&) { return c.restitution; }},
    // elastic energy of a bond at its strength, over its area: sigma_t^2 / (2 E_b) times its length of 2 r
    {"dynamic", "work to fracture", "sigma_t^2 r / (E_b rho g h^2)",
     [](const auto& c, const auto& m) {
       return m.bond.modulus_Pa > 0 ? m.bond.tensile_strength_Pa * m.bond.tensile_strength_Pa * c.particle_radius_m /
                                          (m.bond.modulus_Pa * overburden_Pa(c) * c.tool_depth_m)
                                    : 0.0;
     }},
};

}  // namespace

std::vector<SimilarityGroup> similarity_groups(const SweepTillageConfig& config, const SoilMaterial& material,
                                               double finest_m, double coarsest_m) {
  SweepTillageConfig fine = config, coarse = config;
  fine.particle_radius_m = finest_m;
  coarse.particle_radius_m = coarsest_m;
  std::vector<SimilarityGroup> groups;
  for (const Formula& f : formulas) {
    const double a = f.value(fine, material), b = f.value(coarse, material);
    groups.push_back({f.kind, f.name, f.formula, a, b, std::abs(a - b) <= 1e-12 * std::abs(a)});
  }
  return groups;
}

}  // namespace tilth
