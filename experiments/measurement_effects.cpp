// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/measurement_effects.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tilth {
namespace {

using Change = std::function<double(double)>;

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

std::string_view without_label(std::string_view feature) { return feature.substr(0, feature.find('@')); }

std::size_t column(const Curve& c, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(c.columns, name) - c.columns.begin());
}

void change_features(ExperimentResult& r, const std::function<bool(std::string_view)>& wanted,
                     const Change& change) {
  for (Feature& f : r.features)
    if (wanted(without_label(f.name))) f.value = change(f.value);
}

void change_columns(ExperimentResult& r, std::initializer_list<std::string_view> names,
                    const Change& change) {
  for (Curve& c : r.curves)
    for (const std::string_view name : names)
      if (const std::size_t k = column(c, name); k < c.columns.size())
        for (auto& row : c.rows) row[k] = change(row[k]);
}

double setting(const std::vector<Field>& settings, std::string_view name) {
  const Field* field = find_field(settings, name);
  return field ? *std::get<double*>(field->value) : 0.0;
}

/// @param strain_per_Pa  C / H
void seat(ExperimentResult& r, double strain_per_Pa, double load_to_stress_Pa) {
  const double peak_Pa = r.feature("peak_stress_Pa");
  change_features(
      r, [](std::string_view n) { return n.ends_with("modulus_Pa"); },
      [=](double e) { return 1 / (1 / e + strain_per_Pa); });
  change_features(
      r, [](std::string_view n) { return n == "strain_at_peak"; },
      [=](double strain) { return strain + peak_Pa * strain_per_Pa; });
  change_features(
      r, [](std::string_view n) { return n == "compression_strain"; },
      [=](double strain) { return strain + load_to_stress_Pa * strain_per_Pa; });
  for (Curve& c : r.curves) {
    const std::size_t strain = column(c, "axial_strain");
    const std::size_t stress = column(c, "axial_stress_Pa");
    if (std::max(strain, stress) >= c.columns.size()) continue;
    for (auto& row : c.rows) row[strain] += row[stress] * strain_per_Pa;
  }
}

void add_box_friction(ExperimentResult& r, double stress_Pa) {
  const Change more = [=](double x) { return x + stress_Pa; };
  change_features(
      r, [](std::string_view n) { return n.ends_with("shear_stress_Pa") || n.ends_with("cohesion_Pa"); },
      more);
  change_columns(r, {"shear_stress_Pa"}, more);
}

void multiply_loads(ExperimentResult& r, double gain) {
  const Change times = [=](double x) { return x * (1 + gain); };
  change_features(
      r, [](std::string_view n) { return n.ends_with("_Pa") || n.ends_with("_N"); }, times);
  change_features(
      r, [](std::string_view n) { return n.ends_with("friction_angle_rad"); },
      [=](double angle) { return std::atan((1 + gain) * std::tan(angle)); });
  change_columns(r,
                 {"axial_stress_Pa", "tensile_stress_Pa", "shear_stress_Pa", "interface_stress_Pa",
                  "draught_N", "vertical_N", "side_N"},
                 times);
}

double gain_of(std::string_view test_id, const SoilEffects& e) {
  if (is_one_of(test_id, {"unconfined_compression", "confined_compression", "direct_tension"}))
    return e.frame_load_gain;
  if (is_one_of(test_id, {"direct_shear", "interface_shear"})) return e.shear_box_load_gain;
  return test_id == "sweep_tillage" ? e.draught_load_gain : 0.0;
}

}  // namespace

void apply_measurement_effects(std::string_view test_id, const std::vector<Field>& settings,
                               const SoilEffects& e, ExperimentResult& r) {
  if (r.status != RunStatus::completed) return;
  const double height_m =
      setting(settings, "specimen_height_m") + setting(settings, "ring_height_m");
  if (e.seating_compliance_m_per_Pa != 0 &&
      is_one_of(test_id, {"unconfined_compression", "confined_compression"}))
    seat(r, e.seating_compliance_m_per_Pa / height_m, setting(settings, "load_to_stress_Pa"));
  if (e.shear_box_friction_Pa != 0 && test_id == "direct_shear")
    add_box_friction(r, e.shear_box_friction_Pa);
  if (const double gain = gain_of(test_id, e); gain != 0) multiply_loads(r, gain);
}

}  // namespace tilth
