// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/soil_vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>

#include "calibrate/effect_catalogue.hpp"

namespace tilth {
namespace {

/// Ranges are wide enough for any agricultural topsoil, and narrow enough that no usual value
/// survives a factor of 1000: that is what they are for.
SoilVocabulary built_in() {
  using enum ConditionNeed;
  SoilVocabulary words;
  words.observables = {
      {"unconfined_compression", "peak_stress_Pa", 200.0, 2e6, none},
      {"unconfined_compression", "secant_modulus_Pa", 1e4, 3e8, none},
      {"unconfined_compression", "strain_at_peak", 1e-4, 0.4, none},
      {"direct_shear", "cohesion_Pa", 50.0, 2e5, three_normal_stresses},
      {"direct_shear", "friction_angle_rad", 0.05, 1.1, three_normal_stresses},
      {"direct_shear", "residual_friction_angle_rad", 0.05, 1.1, three_normal_stresses},
      {"direct_shear", "residual_cohesion_Pa", 50.0, 2e5, three_normal_stresses},
      {"direct_shear", "peak_shear_stress_Pa", 200.0, 1e6, one_normal_stress},
      {"direct_shear", "residual_shear_stress_Pa", 200.0, 1e6, one_normal_stress},
      {"confined_compression", "constrained_modulus_Pa", 3e4, 3e8, load_stresses},
      {"confined_compression", "unload_modulus_Pa", 1e5, 1e9, unload_stresses},
      {"confined_compression", "reload_modulus_Pa", 1e5, 1e9, unload_stresses},
      {"confined_compression", "radial_stress_ratio", 0.05, 2.0, load_stresses},
      {"confined_compression", "compression_strain", 1e-4, 0.6, load_stresses},
      {"drained_triaxial", "initial_modulus_Pa", 1e5, 1e9, one_cell_pressure},
      {"drained_triaxial", "peak_stress_ratio", 0.2, 2.5, one_cell_pressure},
      {"drained_triaxial", "strain_at_peak", 1e-3, 0.4, one_cell_pressure},
      {"drained_triaxial", "end_stress_ratio", 0.2, 2.5, one_cell_pressure},
      {"drained_triaxial", "dilation_rate", -0.5, 2.0, one_cell_pressure},
      {"drained_triaxial", "final_volumetric_strain", -0.3, 0.3, one_cell_pressure},
      {"drained_triaxial", "friction_angle_rad", 0.05, 1.1, two_cell_pressures},
      {"drained_triaxial", "cohesion_Pa", 50.0, 2e5, two_cell_pressures},
      {"drained_triaxial", "stiffness_exponent", -0.2, 1.5, two_cell_pressures},
      {"confined_compression", "second_unload_modulus_Pa", 1e5, 1e9, unload_stresses,
       {"second_load_to_stress_Pa"}},
      {"confined_compression", "second_reload_modulus_Pa", 1e5, 1e9, unload_stresses,
       {"second_load_to_stress_Pa"}},
      {"unconfined_compression", "fast_peak_ratio", 0.2, 10.0, none, {"fast_rate_ratio"}},
      {"direct_tension", "tensile_strength_Pa", 20.0, 5e5, none},
      {"direct_tension", "tensile_modulus_Pa", 1e4, 3e8, none},
      {"direct_tension", "strain_at_peak", 1e-5, 0.2, none},
      {"interface_shear", "interface_friction_angle_rad", 0.05, 0.9, three_normal_stresses},
      {"interface_shear", "adhesion_Pa", 1.0, 1e5, three_normal_stresses},
      {"interface_shear", "peak_interface_stress_Pa", 50.0, 1e6, one_normal_stress},
      {"interface_shear", "residual_interface_stress_Pa", 50.0, 1e6, one_normal_stress},
      {"angle_of_repose", "repose_angle_rad", 0.1, 1.4, none},
      {"cone_penetration", "cone_resistance_Pa", 1e3, 2e7, none},
      {"cone_penetration", "cone_resistance_gradient_Pa_per_m", 1e3, 5e8, none},
      {"cone_penetration", "pull_out_force_N", 1e-3, 1e4, none},
      {"vane_shear", "vane_strength_Pa", 200.0, 1e6, none},
      {"vane_shear", "residual_vane_strength_Pa", 100.0, 1e6, none},
      {"vane_shear", "rotation_at_peak_rad", 2e-3, 2.0, none},
      {"sweep_tillage", "forward_displacement_m", -1.0, 10.0, none, {"tracer_depth_m", "tracer_lateral_m"}},
      {"sweep_tillage", "lateral_displacement_m", -3.0, 3.0, none, {"tracer_depth_m", "tracer_lateral_m"}},
      {"sweep_tillage", "vertical_displacement_m", -0.5, 0.5, none, {"tracer_depth_m", "tracer_lateral_m"}},
      {"sweep_tillage", "draught_N", 5.0, 1e5, none},
      {"sweep_tillage", "furrow_area_m2", 1e-5, 1.0, none},
      {"sweep_tillage", "ridge_area_m2", 1e-5, 1.0, none},
      {"sweep_tillage", "disturbed_area_m2", 1e-4, 2.0, none},
  };
  words.parameters = {
      {"bond_modulus_Pa", 0.0, 1e12},
      {"contact_modulus_Pa", 1.0, 1e12},
      {"bond_tensile_strength_Pa", 0.0, 1e10},
      {"bond_cohesion_Pa", 0.0, 1e10},
      {"bond_friction_angle_rad", 0.0, 1.5},
      {"bond_radius_multiplier", 0.05, 2.0},
      {"bond_stiffness_ratio", 0.1, 100.0},
      {"moment_contribution", 0.0, 1.0},
      {"stiffness_ratio", 0.1, 100.0},
      {"friction", 0.0, 5.0},
      {"wall_friction", 0.0, 5.0},
      {"rolling_friction", 0.0, 2.0},
      {"tool_friction", 0.0, 5.0},
      {"local_damping", 0.0, 0.95},
      {"grain_density_kg_per_m3", 500.0, 1e4},
  };
  words.condition_columns = {
      {"water_content", 0.0, 1.0},
      {"bulk_density_kg_per_m3", 300.0, 2500.0},
      {"suction_Pa", 0.0, 1e9},
      {"speed_m_per_s", 0.0, 30.0},
      {"depth_m", 0.0, 3.0},
      {"particle_radius_m", 1e-6, 1.0},
      {"normal_stress_Pa", 100.0, 1e7, true},
      {"cell_pressure_Pa", 1e3, 5e6, true},
      {"relative_density", 0.0, 1.0, true},
      {"load_from_stress_Pa", 0.0, 1e7},
      {"load_to_stress_Pa", 100.0, 1e7},
      {"unload_to_stress_Pa", 0.0, 1e7},
      {"second_load_to_stress_Pa", 100.0, 1e7},
      {"fast_rate_ratio", 1.0, 1000.0},
      {"cut_angle_rad", -3.2, 3.2},
      {"base_diameter_m", 2e-3, 0.2},
      {"apex_angle_rad", 0.1, 3.0},
      {"surcharge_stress_Pa", 1.0, 1e6},
      {"vane_diameter_m", 5e-3, 0.3},
      {"vane_height_m", 5e-3, 0.6},
      {"tool_depth_m", 5e-3, 0.6},
      {"tool_width_m", 0.02, 3.0},
      {"rake_angle_rad", 0.05, 1.5},
      {"tracer_depth_m", 0.0, 1.0, true},
      {"tracer_lateral_m", -2.0, 2.0, true},
  };
  // Upper bounds of stress let no usual test survive a factor of 1000; the lower ones catch kPa.
  words.curves = {{"drained_triaxial",
                   {{"axial_strain", 0.0, 0.6},
                    {"volumetric_strain", -0.4, 0.4},
                    {"axial_stress_Pa", 1e3, 2e7},
                    {"radial_stress_Pa", 1e3, 5e6}},
                   "radial_stress_Pa",
                   "cell_pressure_Pa"}};
  return words;
}

/// The parameters of candidate missing effects, which data/effects.json alone lists.
SoilVocabulary with_effects(SoilVocabulary words) {
  for (const Effect& effect : effect_catalogue())
    for (const EffectParameter& p : effect.parameters)
      if (!words.parameter(p.name)) words.parameters.push_back({p.name, p.lower, p.upper});
  return words;
}

struct OtherUnit {
  const char* suffix;  ///< as people write it at the end of a name
  const char* si;      ///< what the name must end in
  double factor;       ///< SI value = factor * value
};

constexpr double degree = std::numbers::pi / 180.0;
constexpr OtherUnit other_units[] = {
    {"kPa", "Pa", 1e3},
    {"MPa", "Pa", 1e6},
    {"GPa", "Pa", 1e9},
    {"hPa", "Pa", 1e2},
    {"bar", "Pa", 1e5},
    {"deg", "rad", degree},
    {"mm", "m", 1e-3},
    {"cm", "m", 1e-2},
    {"kN", "N", 1e3},
    {"ms", "s", 1e-3},
    {"percent", "", 1e-2},
    {"g_per_cm3", "kg_per_m3", 1e3},
    {"Mg_per_m3", "kg_per_m3", 1e3},
    {"km_per_h", "m_per_s", 1.0 / 3.6},
    {"kmh", "m_per_s", 1.0 / 3.6},
};

bool ends_in_unit(std::string_view name, std::string_view unit) {
  if (unit.empty() || name.size() <= unit.size() + 1 || !name.ends_with(unit)) return false;
  return name[name.size() - unit.size() - 1] == '_';
}

bool has_si_unit(std::string_view name) {
  constexpr const char* units[] = {"Pa", "m", "s", "kg", "rad", "N", "J", "Hz", "m2", "m3"};
  return std::any_of(std::begin(units), std::end(units),
                     [name](const char* unit) { return ends_in_unit(name, unit); });
}

}  // namespace

const SoilVocabulary& soil_vocabulary() {
  static const SoilVocabulary words = with_effects(built_in());
  return words;
}

std::vector<std::string> SoilVocabulary::test_ids() const {
  std::vector<std::string> ids;
  for (const KnownObservable& known : observables) {
    if (std::find(ids.begin(), ids.end(), known.test_id) == ids.end()) ids.push_back(known.test_id);
  }
  return ids;
}

std::vector<std::string> SoilVocabulary::observable_ids(std::string_view test_id) const {
  std::vector<std::string> ids;
  for (const KnownObservable& known : observables) {
    if (known.test_id == test_id) ids.push_back(known.observable_id);
  }
  return ids;
}

std::vector<std::string> SoilVocabulary::parameter_ids() const {
  std::vector<std::string> ids;
  for (const KnownParameter& known : parameters) ids.push_back(known.id);
  return ids;
}

const KnownObservable* SoilVocabulary::observable(std::string_view test_id,
                                                  std::string_view observable_id) const {
  for (const KnownObservable& known : observables) {
    if (known.test_id == test_id && known.observable_id == observable_id) return &known;
  }
  return nullptr;
}

const KnownParameter* SoilVocabulary::parameter(std::string_view id) const {
  for (const KnownParameter& known : parameters) {
    if (known.id == id) return &known;
  }
  return nullptr;
}

bool has_si_name(std::string_view name, std::string* reason) {
  for (const OtherUnit& unit : other_units) {
    if (!ends_in_unit(name, unit.suffix)) continue;
    if (reason != nullptr) {
      const std::string_view si = unit.si;
      *reason =
          fmt::format("'{}' ends in _{}: names end in their SI unit, {}", name, unit.suffix,
                      si.empty() ? "or in none when dimensionless" : fmt::format("here _{}", si));
    }
    return false;
  }
  return true;
}

std::string unit_hint(std::string_view name, double value, double lower, double upper) {
  for (const OtherUnit& unit : other_units) {
    const std::string_view si = unit.si;
    const bool same_quantity = si.empty() ? !has_si_unit(name) : ends_in_unit(name, si);
    const double converted = value * unit.factor;
    if (same_quantity && converted >= lower && converted <= upper) {
      return fmt::format("; given in {}? write {:.6g}{}{}", unit.suffix, converted,
                         si.empty() ? "" : " ", si);
    }
  }
  for (const double factor : {1e-3, 1e-6}) {
    const double converted = value * factor;
    if (converted >= lower && converted <= upper) {
      return fmt::format("; {:.0f} times too large? Convert once to {}, then it is {:.6g}",
                         1.0 / factor, ends_in_unit(name, "Pa") ? "Pa" : "SI", converted);
    }
  }
  return "";
}

}  // namespace tilth
