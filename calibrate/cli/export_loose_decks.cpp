// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// LAMMPS and LIGGGHTS: contact law only, one type per class of radii.
#include <fmt/format.h>

#include <functional>

#include "calibrate/cli/export_classes.hpp"
#include "calibrate/cli/export_decks.hpp"
#include "calibrate/cli/export_template.hpp"

namespace tilth {
namespace {

/// 12 classes: with radii within 25 % of their mean a stiffness is off by 2 % on average at most.
constexpr int num_classes = 12;

TemplateValues loose_values(const ExportSource& source, const ExportSpecimen& s,
                            const RadiusClasses& classes) {
  return {{"HEADER", comment_lines("#", deck_lines(source, s))},
          {"RADIUS_FACTOR", fmt::format("{:.6f}", s.radius_factor)},
          {"CLASS_ERROR_PERCENT", fmt::format("{:.1f}", 100 * classes.largest_error)},
          {"RESTITUTION", number_text(export_restitution)},
          {"SKIN_M", number_text(0.3 * s.mean_radius_m)},
          {"SPECIMEN_RADIUS_M", number_text(s.container_radius_m)},
          {"PLATEN_SPEED_M_PER_S", number_text(s.platen_speed_m_per_s)},
          {"PLATEN_BOTTOM_M", number_text(0.0)},
          {"PLATEN_TOP_M", number_text(s.height_m)},
          {"TIME_STEP_S", number_text(s.dt_s)},
          {"FINAL_STRAIN", number_text(s.final_strain)},
          {"OUTPUT_EVERY_STEPS", fmt::format("{}", export_interval_steps)}};
}

/// Data file of both codes: id type diameter density x y z.
std::string spheres_data(const ExportSpecimen& s, const RadiusClasses& classes,
                         std::size_t num_types, double density_kg_per_m3) {
  const double x_m = 1.5 * s.container_radius_m;
  std::string text = fmt::format(
      "spheres, type = radius class\n\n{} atoms\n{} atom types\n\n{} {} xlo xhi\n{} {} ylo yhi\n"
      "{} {} zlo zhi\n\nAtoms\n\n",
      s.radius_m.size(), num_types, -x_m, x_m, -x_m, x_m, -s.mean_radius_m,
      s.height_m + s.mean_radius_m);
  for (std::size_t i = 0; i < s.radius_m.size(); ++i)
    text += fmt::format("{} {} {} {} {} {} {}\n", i + 1, classes.class_of[i] + 1, 2 * s.radius_m[i],
                        density_kg_per_m3, s.position_m[i].x(), s.position_m[i].y(),
                        s.position_m[i].z());
  return text;
}

/// "hooke k_n gamma tangential linear_history k_t 0.5 mu damping mass_velocity".
std::string lammps_law(const ClassContact& c) {
  return fmt::format("hooke {} {} tangential linear_history {} 0.5 {} damping mass_velocity",
                     c.normal_stiffness_N_per_m, c.normal_damping_per_s, c.shear_stiffness_N_per_m,
                     c.friction);
}

std::string lammps_pairs(const SoilMaterial& m, const RadiusClasses& classes) {
  std::string text;
  for (std::size_t a = 0; a < classes.radius_m.size(); ++a)
    for (std::size_t b = a; b < classes.radius_m.size(); ++b)
      text += fmt::format("{}pair_coeff      {} {} {}", text.empty() ? "" : "\n", a + 1, b + 1,
                          lammps_law(class_contact(m, classes.radius_m[a], classes.radius_m[b],
                                                   export_restitution)));
  return text;
}

std::string lammps_walls(const SoilMaterial& m, const RadiusClasses& classes) {
  std::string text;
  for (std::size_t k = 0; k < classes.radius_m.size(); ++k) {
    const std::string law = lammps_law(wall_contact(m, classes.radius_m[k], export_restitution));
    text += fmt::format(
        "{0}group           class{1} type {1}\n"
        "fix             side{1} class{1} wall/gran/region granular {2} region mantle\n"
        "fix             floor{1} class{1} wall/gran granular {2} zplane ${{bottom}} NULL\n"
        "fix             lid{1} class{1} wall/gran/region granular {2} region platen contacts\n"
        "compute         push{1} class{1} reduce sum f_lid{1}[4]",
        k > 0 ? "\n" : "", k + 1, law);
  }
  return text;
}

std::string lammps_lid_force(std::size_t types) {
  std::string text;
  for (std::size_t k = 1; k <= types; ++k) text += fmt::format("{}c_push{}", k > 1 ? "+" : "", k);
  return text;
}

/// Symmetric matrix over the classes and, last, the walls; rows one after another.
std::string matrix(const SoilMaterial& m, const RadiusClasses& classes,
                   const std::function<double(const ClassContact&)>& entry) {
  const std::size_t walls = classes.radius_m.size();
  std::string text;
  for (std::size_t a = 0; a <= walls; ++a)
    for (std::size_t b = 0; b <= walls; ++b) {
      const std::size_t grain =
          a == walls ? (b == walls ? 0 : b) : a;  // wall on wall is never used
      const ClassContact c =
          a == walls || b == walls
              ? wall_contact(m, classes.radius_m[grain], export_restitution)
              : class_contact(m, classes.radius_m[a], classes.radius_m[b], export_restitution);
      text += fmt::format("{}{}", text.empty() ? "" : " ", entry(c));
    }
  return text;
}

/// Two triangles at z = 0 whose normal points down, wider than the cylinder.
std::string platen_stl(double half_width_m) {
  const double w = half_width_m;
  const double corner[2][3][2] = {{{-w, -w}, {w, w}, {w, -w}}, {{-w, -w}, {-w, w}, {w, w}}};
  std::string text = "solid platen\n";
  for (const auto& triangle : corner) {
    text += " facet normal 0 0 -1\n  outer loop\n";
    for (const auto& p : triangle) text += fmt::format("   vertex {} {} 0\n", p[0], p[1]);
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid platen\n";
}

}  // namespace

std::vector<ExportFile> lammps_files(const ExportSource& source, const ExportSpecimen& s) {
  const SoilMaterial& m = source.set.material;
  const RadiusClasses classes = radius_classes(s.radius_m, num_classes);
  const std::size_t types = classes.radius_m.size();
  TemplateValues values = loose_values(source, s, classes);
  values["PAIR_COEFFICIENTS"] = lammps_pairs(m, classes);
  values["WALLS"] = lammps_walls(m, classes);
  values["LID_FORCE"] = lammps_lid_force(types);
  return {{"confined_compression.in", fill_template(lammps_template, values)},
          {"spheres.data", spheres_data(s, classes, types, m.density_kg_per_m3)},
          {"tilth_curve.csv", curve_csv(s.reference)}};
}

std::vector<ExportFile> liggghts_files(const ExportSource& source, const ExportSpecimen& s) {
  const SoilMaterial& m = source.set.material;
  const RadiusClasses classes = radius_classes(s.radius_m, num_classes);
  const std::size_t types = classes.radius_m.size() + 1;
  TemplateValues values = loose_values(source, s, classes);
  values["TYPES"] = fmt::format("{}", types);
  values["KN_MATRIX"] =
      matrix(m, classes, [](const ClassContact& c) { return c.normal_stiffness_N_per_m; });
  values["KT_MATRIX"] =
      matrix(m, classes, [](const ClassContact& c) { return c.shear_stiffness_N_per_m; });
  values["GAMMAN_MATRIX"] =
      matrix(m, classes, [](const ClassContact& c) { return c.normal_damping_per_s; });
  values["GAMMAT_MATRIX"] =
      matrix(m, classes, [](const ClassContact& c) { return 0.5 * c.normal_damping_per_s; });
  values["FRICTION_MATRIX"] = matrix(m, classes, [](const ClassContact& c) { return c.friction; });
  return {{"confined_compression.in", fill_template(liggghts_template, values)},
          {"spheres.data", spheres_data(s, classes, types, m.density_kg_per_m3)},
          {"platen.stl", platen_stl(2 * s.container_radius_m)},
          {"tilth_curve.csv", curve_csv(s.reference)}};
}

}  // namespace tilth
