// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// YADE and PFC: codes whose bonds carry our law.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "calibrate/cli/export_decks.hpp"
#include "calibrate/cli/export_template.hpp"

namespace tilth {
namespace {

/// What both decks ask for.
TemplateValues bonded_values(const ExportSource& source, const ExportSpecimen& s,
                             std::string_view comment) {
  const SoilMaterial& m = source.set.material;
  return {{"HEADER", comment_lines(comment, deck_lines(source, s))},
          {"GRAIN_DENSITY_KG_PER_M3", number_text(m.density_kg_per_m3)},
          {"CONTACT_MODULUS_PA", number_text(m.contact_modulus_Pa)},
          {"CONTACT_STIFFNESS_RATIO", number_text(m.contact_stiffness_ratio)},
          {"CONTACT_FRICTION", number_text(m.friction)},
          {"WALL_FRICTION", number_text(m.wall_friction)},
          {"BOND_MODULUS_PA", number_text(m.bond.modulus_Pa)},
          {"BOND_STIFFNESS_RATIO", number_text(m.bond.stiffness_ratio)},
          {"BOND_RADIUS_MULTIPLIER", number_text(m.bond.radius_multiplier)},
          {"BOND_TENSILE_STRENGTH_PA", number_text(m.bond.tensile_strength_Pa)},
          {"BOND_COHESION_PA", number_text(m.bond.cohesion_Pa)},
          {"BOND_MOMENT_CONTRIBUTION", number_text(m.bond.moment_contribution)},
          {"LOCAL_DAMPING", number_text(m.local_damping)},
          {"SPECIMEN_RADIUS_M", number_text(s.container_radius_m)},
          {"PLATEN_SPEED_M_PER_S", number_text(s.platen_speed_m_per_s)},
          {"PLATEN_BOTTOM_M", number_text(0.0)},
          {"PLATEN_TOP_M", number_text(s.height_m)},
          {"TIME_STEP_S", number_text(s.dt_s)},
          {"FINAL_STRAIN", number_text(s.final_strain)},
          {"OUTPUT_EVERY_STEPS", fmt::format("{}", export_interval_steps)}};
}

std::string ball_lines(const ExportSpecimen& s) {
  std::string text;
  for (std::size_t i = 0; i < s.radius_m.size(); ++i) {
    const Vec3& x = s.position_m[i];
    text += fmt::format("{}ball create id {} radius {} position ({}, {}, {})", i > 0 ? "\n" : "",
                        i + 1, s.radius_m[i], x.x(), x.y(), x.z());
  }
  return text;
}

std::string bond_lines(const ExportSpecimen& s) {
  std::string text;
  for (const BondGeometry& b : s.bonds)
    text += fmt::format("{}[map.add(pairs, {} * KEY + {}, 1)]", text.empty() ? "" : "\n", b.i + 1,
                        b.j + 1);
  return text;
}

}  // namespace

std::vector<ExportFile> yade_files(const ExportSource& source, const ExportSpecimen& s) {
  TemplateValues values = bonded_values(source, s, "#");
  values["BOND_FRICTION_ANGLE_RAD"] = number_text(source.set.material.bond.friction_angle_rad);
  return {{"unconfined_compression.py", fill_template(yade_template, values)},
          {"spheres.csv", spheres_csv(s)},
          {"bonds.csv", bonds_csv(s)},
          {"tilth_curve.csv", curve_csv(s.reference)}};
}

std::vector<ExportFile> pfc_files(const ExportSource& source, const ExportSpecimen& s) {
  TemplateValues values = bonded_values(source, s, ";");
  const double half_m = std::max(2 * s.container_radius_m, 1.5 * s.height_m);
  values["BOND_FRICTION_ANGLE_DEG"] =
      number_text(source.set.material.bond.friction_angle_rad * 180 / std::numbers::pi);
  values["DOMAIN_MIN_M"] = number_text(-half_m);
  values["DOMAIN_MAX_M"] = number_text(half_m);
  values["BOND_GAP_M"] = number_text(1.01 * s.bond_gap_m);
  values["NUM_SPHERES_PLUS_1"] = fmt::format("{}", s.radius_m.size() + 1);
  values["BALLS"] = ball_lines(s);
  values["BONDS"] = bond_lines(s);
  return {{"unconfined_compression.p3dat", fill_template(pfc_template, values)},
          {"tilth_curve.csv", curve_csv(s.reference)}};
}

}  // namespace tilth
