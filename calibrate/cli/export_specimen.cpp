// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/export_specimen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibrate/cli/virtual_test.hpp"
#include "calibrate/config_error.hpp"
#include "dem_core/neighbours.hpp"
#include "dem_core/step.hpp"
#include "dem_core/time_step.hpp"
#include "experiments/specimen.hpp"

namespace tilth {
namespace {

template <class Config>
Config config_of(const char* test, int num_particles, std::uint64_t seed) {
  Config config = std::get<Config>(virtual_test(test, Fidelity::confirm));
  config.num_particles = num_particles;
  config.packing_seed = seed;
  const std::vector<std::string> wrong = range_problems(fields(config));
  if (!wrong.empty()) throw ConfigError(wrong);
  return config;
}

std::vector<Wall> walls_of(const ExportSpecimen& s) {
  std::vector<Wall> walls = {
      {.direction = Vec3::UnitZ()},
      {.direction = -Vec3::UnitZ(), .position_m = s.height_m * Vec3::UnitZ()}};
  if (s.container_radius_m > 0)
    walls.push_back({.shape = WallShape::cylinder, .radius_m = s.container_radius_m});
  return walls;
}

ExportSpecimen placed(const Packing& packing, double radius_m, double height_m) {
  ExportSpecimen s;
  s.radius_m = packing.radius_m;
  s.position_m = packing.position_m;
  s.mean_radius_m = packing.mean_radius_m;
  s.container_radius_m = radius_m;
  s.height_m = height_m;
  return s;
}

/// Largest factor on all radii that leaves no overlap, at most 1.
double overlap_free_factor(const ExportSpecimen& s) {
  double factor = 1.0;
  for (std::size_t i = 0; i < s.radius_m.size(); ++i) {
    const Vec3& x = s.position_m[i];
    const double to_wall_m =
        std::min({x.z(), s.height_m - x.z(), s.container_radius_m - std::hypot(x.x(), x.y())});
    factor = std::min(factor, to_wall_m / s.radius_m[i]);
    for (std::size_t j = 0; j < i; ++j)
      factor = std::min(factor, (x - s.position_m[j]).norm() / (s.radius_m[i] + s.radius_m[j]));
  }
  return factor;
}

}  // namespace

ExportSpecimen bonded_specimen(const SoilMaterial& material, int num_particles, std::uint64_t seed,
                               PackingStore& packings) {
  const auto config =
      config_of<UnconfinedCompressionConfig>("unconfined_compression", num_particles, seed);
  const auto packing = packings.get(packing_spec(config));
  ExportSpecimen s = placed(*packing, config.specimen_radius_m, config.specimen_height_m);
  s.bond_gap_m = config.bond_gap_over_radius * packing->mean_radius_m;
  s.platen_speed_m_per_s = config.platen_speed_over_wave_speed * wave_speed_m_per_s(material);
  ExportSpecimen open = s;
  open.container_radius_m = 0;
  const SoilMaterial members[] = {material};
  const Specimen made =
      make_specimen(*packing, members, walls_of(open), {config.bond_gap_over_radius});
  s.bonds = made.model.bonds;
  s.dt_s = made.model.lanes.front().dt_s;
  s.packing = fmt::format(
      "unconfined compression of {} spheres, {} bonds, packing seed {}, porosity {} before "
      "overlaps; "
      "our own curve again: calibrate simulate --experiment unconfined_compression --fit FIT --set "
      "num_particles={} --seed {}",
      num_particles, s.bonds.size(), seed, config.porosity, num_particles, seed);
  const ExperimentResult run = run_unconfined_compression(members, config, packings).front();
  if (run.status != RunStatus::completed)
    throw ConfigError(
        {fmt::format("our own run of the specimen ended with '{}' ({}): a deck of it "
                     "would show nothing; use other --particles or --seed",
                     name_of(run.status), run.message)});
  s.reference = run.curves.front();
  s.final_strain = s.reference.rows.back().front();
  return s;
}

Model loose_model(const ExportSpecimen& s, const SoilMaterial& material) {
  Model model;
  model.radius_m = s.radius_m;
  model.mass_kg = sphere_masses_kg(s.radius_m, material.density_kg_per_m3);
  model.walls = walls_of(s);
  LaneLaw law = lane_law(material);
  law.local_damping = 0;
  law.normal_damping = damping_number(export_restitution);
  law.tangential_damping = 0.5 * law.normal_damping;
  law.dt_s = s.dt_s;
  model.lanes = {law};
  return model;
}

Curve compress(const Model& model, const ExportSpecimen& s, double end_stress_Pa,
               double end_strain) {
  State state = initial_state(model, s.position_m);
  state.drive(1, 0).velocity_m_per_s = -s.platen_speed_m_per_s * Vec3::UnitZ();
  Workspace workspace;
  Curve curve{"stress_strain", {"axial_strain", "axial_stress_Pa"}, {}};
  const double area_m2 = std::numbers::pi * s.container_radius_m * s.container_radius_m;
  for (double strain = 0, stress_Pa = 0; strain < end_strain && stress_Pa < end_stress_Pa;) {
    double sum_N = 0;
    for (int n = 0; n < export_interval_steps; ++n) {
      if (step(model, state, workspace).lane_failed)
        throw std::runtime_error("export: our own run of the loose specimen diverged");
      sum_N += state.wall_force_N(1).z();
    }
    const double middle_s = state.time_s[0] - 0.5 * export_interval_steps * s.dt_s;
    strain = middle_s * s.platen_speed_m_per_s / s.height_m;
    stress_Pa = sum_N / export_interval_steps / area_m2;
    curve.rows.push_back({strain, stress_Pa});
  }
  return curve;
}

ExportSpecimen loose_specimen(const SoilMaterial& material, int num_particles, std::uint64_t seed,
                              PackingStore& packings) {
  const auto config =
      config_of<ConfinedCompressionConfig>("confined_compression", num_particles, seed);
  const auto packing = packings.get(packing_spec(config));
  ExportSpecimen s = placed(*packing, config.ring_radius_m, config.ring_height_m);
  s.platen_speed_m_per_s = config.platen_speed_over_wave_speed * wave_speed_m_per_s(material);
  s.radius_factor = overlap_free_factor(s);
  // The step is that of the touching packing with the masses of the smaller spheres.
  s.dt_s = 1;
  Model touching = loose_model(s, material);
  for (double& m : touching.mass_kg) m *= std::pow(s.radius_factor, 3);
  const State state = initial_state(touching, s.position_m);
  s.dt_s = ladder_time_step_s(0.8 * stable_time_step_s(touching, state));
  for (double& r : s.radius_m) r *= s.radius_factor;
  s.mean_radius_m *= s.radius_factor;
  s.packing = fmt::format(
      "confined compression of {} unbonded spheres, packing seed {}, porosity {:.4f}: radii of our "
      "packing (porosity {} before overlaps) times {:.6f}",
      num_particles, seed, 1 - (1 - config.porosity) * std::pow(s.radius_factor, 3),
      config.porosity, s.radius_factor);
  s.reference =
      compress(loose_model(s, material), s, config.load_to_stress_Pa, config.max_axial_strain);
  s.final_strain = s.reference.rows.back().front();
  return s;
}

std::vector<std::string> deck_lines(const ExportSource& source, const ExportSpecimen& s) {
  std::vector<std::string> lines = about_lines(source);
  lines.push_back("");
  lines.push_back("The fitted set:");
  for (const ExportRow& row : export_rows(source)) lines.push_back("  " + row_sentence(row));
  if (const double mu = source.set.material.rolling_friction; mu > 0)
    lines.push_back(fmt::format("NOT in this deck: rolling_friction = {} (type C of Ai et al. 2011, "
                                "k_r = k_s Rbar^2)", mu));
  SoilEffects effects = source.set.material.effects, none;
  const std::vector<Field> baseline = fields(none);
  for (const Field& f : fields(effects))
    if (const std::string value = field_text(f); value != field_text(*find_field(baseline, f.name)))
      lines.push_back(fmt::format("NOT in this deck: {} = {} (calibrate effects)", f.name, value));
  lines.push_back("");
  lines.push_back("Specimen: " + s.packing);
  return lines;
}

std::string spheres_csv(const ExportSpecimen& s) {
  std::string text = "# " + s.packing + "\nx_m,y_m,z_m,radius_m\n";
  for (std::size_t i = 0; i < s.radius_m.size(); ++i)
    text += fmt::format("{},{},{},{}\n", s.position_m[i].x(), s.position_m[i].y(),
                        s.position_m[i].z(), s.radius_m[i]);
  return text;
}

std::string bonds_csv(const ExportSpecimen& s) {
  std::string text =
      "# rows of spheres.csv, from 0; distance without force in the bond\n"
      "first,second,rest_length_m\n";
  for (const BondGeometry& b : s.bonds)
    text += fmt::format("{},{},{}\n", b.i, b.j, b.rest_length_m);
  return text;
}

}  // namespace tilth
