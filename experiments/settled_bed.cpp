// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/settled_bed.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "dem_core/time_step.hpp"

namespace tilth {
namespace {

LaneLaw loose_law(SoilMaterial m, const LooseBedSpec& spec) {
  if (spec.stiffness_over_weight > 0)
    m.contact_modulus_Pa =
        spec.stiffness_over_weight * m.density_kg_per_m3 * spec.gravity_m_per_s2 * spec.depth_m;
  m.wall_friction = 0;
  m.local_damping = spec.local_damping;
  LaneLaw law = lane_law(m);
  law.bond = {};
  law.normal_damping = damping_number(spec.restitution);
  law.tangential_damping = law.normal_damping * law.shear_stiffness_ratio;
  return law;
}

/// Bound of a grain among eight equal ones around it: with sum n n^T = 8/3 of the unit matrix,
///   k_u = 2 (8/3) (k_n + 2 k_s) / m,   k_theta = 2 (16/3) (k_s r^2 + k_r) / (2/5 m r^2),
/// dashpots likewise; dt = 4 / (c + sqrt(c^2 + 4 k)) (time_step.md, 4 and 5).
/// @pre modulus stiffness and restitution damping, which are the model's defaults
double crowded_time_step_s(const LaneLaw& law, double mass_kg, double radius_m) {
  const double kn =
      law.contact_stiffness * stiffness_bound(law.effects) * std::numbers::pi * 0.5 * radius_m;
  const double c = std::sqrt(0.5 * mass_kg * kn);
  const auto rate = [&](double normal, double shear, double rolling) {
    return std::max(16.0 / 3 * (normal + 2 * shear), 32.0 / 3 * (shear + rolling) / 0.4) / mass_kg;
  };
  const double ks = kn * law.shear_stiffness_ratio;
  const double k = rate(kn, ks, law.rolling_friction > 0 ? 0.25 * ks : 0.0);
  const double d = rate(c * law.normal_damping, c * law.tangential_damping, 0.0);
  return 4 / (d + std::sqrt(d * d + 4 * k));
}

}  // namespace

Specimen make_loose_bed(const Packing& packing, std::span<const SoilMaterial> materials,
                        const std::vector<Wall>& walls, const LooseBedSpec& spec) {
  Specimen s;
  s.mean_radius_m = packing.mean_radius_m;
  s.model.radius_m = packing.radius_m;
  s.model.mass_kg = sphere_masses_kg(packing.radius_m, materials.front().density_kg_per_m3);
  s.model.walls = walls;
  s.model.num_fixed = spec.num_fixed;
  s.model.gravity_m_per_s2 = -spec.gravity_m_per_s2 * Vec3::UnitZ();
  for (const SoilMaterial& m : materials) {
    LaneLaw law = loose_law(m, spec);
    double dt_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = static_cast<std::size_t>(spec.num_fixed); i < packing.radius_m.size(); ++i)
      dt_s = std::min(dt_s, crowded_time_step_s(law, s.model.mass_kg[i], packing.radius_m[i]));
    law.dt_s = ladder_time_step_s(0.8 * dt_s);
    s.model.lanes.push_back(law);
  }
  s.state = initial_state(s.model, packing.position_m);
  return s;
}

double agitation(const LaneRun& run, int lane) {
  const Model& model = run.specimen.model;
  double weight_N = 0.0;
  double kinetic_J = 0.0;
  for (int i = model.num_fixed; i < model.num_particles(); ++i) {
    const double m = model.mass_kg[static_cast<std::size_t>(i)];
    weight_N += m * model.gravity_m_per_s2.norm();
    kinetic_J += 0.5 * m * run.specimen.state.velocity_m_per_s(i, lane).squaredNorm();
  }
  return kinetic_J / (weight_N * run.specimen.mean_radius_m);
}

double bed_height_m(const LaneRun& run, int lane) {
  const Model& model = run.specimen.model;
  double top_m = 0.0;
  for (int i = model.num_fixed; i < model.num_particles(); ++i)
    top_m = std::max(top_m, run.specimen.state.position_m(i, lane).z() +
                                model.radius_m[static_cast<std::size_t>(i)]);
  return top_m;
}

}  // namespace tilth
