// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/setup_effects.hpp"

#include <algorithm>
#include <cmath>

namespace tilth {
namespace {

/// Speeds that are a numerical choice. A sweep's speed_m_per_s is not among them.
constexpr std::string_view rates[] = {
    "platen_speed_over_wave_speed", "shear_speed_over_wave_speed", "pull_speed_over_wave_speed",
    "slide_speed_over_wave_speed",  "tip_speed_over_wave_speed",   "wall_speed_over_fall_speed",
    "inertial_number"};

constexpr std::string_view lengths[] = {
    "specimen_radius_m", "specimen_height_m", "ring_radius_m",    "ring_height_m",
    "box_length_m",      "box_height_m",      "box_width_m",      "side_m",
    "chamber_radius_m",  "bed_height_m",      "column_length_m",  "column_height_m",
    "slab_thickness_m",  "bin_width_m"};

/// Multiplies a setting of that name, where there is one; inside its range.
void scale(const std::vector<Field>& settings, std::string_view name, double factor) {
  const Field* field = find_field(settings, name);
  if (!field || factor == 1.0) return;
  if (auto* const* x = std::get_if<double*>(&field->value))
    **x = std::clamp(**x * factor, field->lower, field->upper);
  if (auto* const* n = std::get_if<int*>(&field->value))
    **n = static_cast<int>(std::lround(std::clamp(**n * factor, field->lower, field->upper)));
}

void change_porosity(const std::vector<Field>& settings, double offset) {
  const Field* field = find_field(settings, "porosity");
  if (!field || offset == 0.0) return;
  double& porosity = *std::get<double*>(field->value);
  const double before = porosity;
  porosity = std::clamp(before + offset, field->lower, field->upper);
  const double denser = (1 - porosity) / (1 - before);
  scale(settings, "num_particles", denser);
  scale(settings, "bulk_density_kg_per_m3", denser);
}

}  // namespace

std::array<double, 5> setup_key(const SoilEffects& e) {
  return {e.porosity_offset, e.particle_size_change, e.loading_rate_change, e.domain_size_change,
          e.tool_depth_offset_m};
}

void apply_setup_effects(std::string_view test_id, const std::vector<Field>& settings,
                         const SoilEffects& e) {
  change_porosity(settings, e.porosity_offset);
  const double size = 1 + e.particle_size_change;
  scale(settings, "num_particles", 1 / (size * size * size));
  scale(settings, "particle_radius_m", size);
  const double rate = 1 + e.loading_rate_change;
  for (const std::string_view name : rates) scale(settings, name, rate);
  if (test_id == "cone_penetration") scale(settings, "speed_m_per_s", rate);
  const double wider = 1 + e.domain_size_change;
  for (const std::string_view name : lengths) scale(settings, name, wider);
  scale(settings, "num_particles", wider * wider * wider);
  if (const Field* depth = find_field(settings, "tool_depth_m"); depth && e.tool_depth_offset_m != 0)
    *std::get<double*>(depth->value) += e.tool_depth_offset_m;
}

int day_of_test(std::string_view test_id) {
  if (test_id == "direct_shear" || test_id == "direct_tension" || test_id == "interface_shear") return 1;
  if (test_id == "cone_penetration" || test_id == "vane_shear" || test_id == "sweep_tillage") return 2;
  return 0;
}

SoilMaterial on_day_of_test(std::string_view test_id, SoilMaterial material) {
  const double factor = 1 + material.effects.strength_drift * day_of_test(test_id);
  material.bond.tensile_strength_Pa *= factor;
  material.bond.cohesion_Pa *= factor;
  return material;
}

}  // namespace tilth
