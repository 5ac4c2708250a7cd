// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/virtual_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "calibrate/config_error.hpp"
#include "calibrate/nearest_name.hpp"
#include "experiments/measurement_effects.hpp"
#include "experiments/setup_effects.hpp"

namespace tilth {
namespace {

/// Sizes and speeds of the fidelities; what they cost and how far they are off: docs/experiments/.
struct Size {
  int num_particles = 0;
  double speed_over_wave_speed = 0.0;
};

Size size_of(Fidelity fidelity) {
  switch (fidelity) {
    case Fidelity::preview: return {300, 1.2e-3};
    case Fidelity::search: return {500, 8e-4};
    case Fidelity::confirm: return {1500, 3e-4};
  }
  return {};
}

/// Shear box travel over its length. The peaks of the three soils come before 8 %.
constexpr double shear_strain = 0.08;

void apply_fidelity(UnconfinedCompressionConfig& c, Fidelity fidelity) {
  c.num_particles = size_of(fidelity).num_particles;
  // A brittle peak needs a slower platen than the other tests: +31 % at 8e-4, +4 % at 1e-4, +2 % at
  // 5e-5 against standing still; it is also the cheapest test.
  c.platen_speed_over_wave_speed = 0.25 * size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(DirectShearConfig& c, Fidelity fidelity) {
  c.num_particles = size_of(fidelity).num_particles;
  c.shear_speed_over_wave_speed = size_of(fidelity).speed_over_wave_speed;
  c.max_shear_strain = shear_strain;
}

void apply_fidelity(ConfinedCompressionConfig& c, Fidelity fidelity) {
  c.num_particles = size_of(fidelity).num_particles;
  c.platen_speed_over_wave_speed = size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(DrainedTriaxialConfig& c, Fidelity fidelity) {
  // Sizes and rates of its own: a series is many tests, and their rate is the inertial number.
  switch (fidelity) {
    case Fidelity::preview: c.num_particles = 150, c.inertial_number = 4e-3; break;
    case Fidelity::search: c.num_particles = 200, c.inertial_number = 4e-3; break;
    case Fidelity::confirm: c.num_particles = 600, c.inertial_number = 2e-3; break;
  }
}

void apply_fidelity(DirectTensionConfig& c, Fidelity fidelity) {
  c.num_particles = size_of(fidelity).num_particles;
  // As brittle as unconfined compression.
  c.pull_speed_over_wave_speed = 0.25 * size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(InterfaceShearConfig& c, Fidelity fidelity) {
  c.num_particles = size_of(fidelity).num_particles;
  c.slide_speed_over_wave_speed = size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(ConePenetrationConfig& c, Fidelity fidelity) {
  // Twice the grains: the chamber is wide for its cone. Speed as a multiple of the standard's 30 mm/s.
  c.num_particles = 2 * size_of(fidelity).num_particles;
  c.speed_m_per_s = 100 * size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(VaneShearConfig& c, Fidelity fidelity) {
  c.num_particles = 2 * size_of(fidelity).num_particles;
  c.tip_speed_over_wave_speed = size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(AngleOfReposeConfig& c, Fidelity fidelity) {
  c.num_particles = size_of(fidelity).num_particles;
  // 0.45, 0.3 and 0.11 of sqrt(g d)
  c.wall_speed_over_fall_speed = 375 * size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(SweepTillageConfig& c, Fidelity fidelity) {
  // Coarse aggregates and narrower bins to search, finer ones to confirm: 725, 1250 and 4270 of them. The
  // tool, its depth and its speed stay, so that the answer is the same quantity; what the size of the
  // aggregates does to it is the bias a fit measures.
  switch (fidelity) {
    case Fidelity::preview: c.particle_radius_m = 0.030, c.bin_length_m = 1.1, c.bin_width_m = 0.6; break;
    case Fidelity::search: c.particle_radius_m = 0.025, c.bin_length_m = 1.1, c.bin_width_m = 0.6; break;
    case Fidelity::confirm: c.particle_radius_m = 0.018; break;
  }
}

std::vector<std::string> own_problems(const DrainedTriaxialConfig& c) { return problems(c); }
std::vector<std::string> own_problems(const SweepTillageConfig& c) { return problems(c); }
std::vector<std::string> own_problems(const auto&) { return {}; }

bool same_values(TestConfig a, TestConfig b) {
  if (a.index() != b.index()) return false;
  const std::vector<Field> left = fields(a);
  const std::vector<Field> right = fields(b);
  return std::ranges::equal(left, right, [](const Field& x, const Field& y) {
    return field_text(x) == field_text(y);
  });
}

/// In the order of TestConfig.
constexpr const char* ids[] = {"unconfined_compression", "direct_shear",     "confined_compression",
                               "drained_triaxial",       "direct_tension",   "interface_shear",
                               "cone_penetration",       "vane_shear",       "angle_of_repose",
                               "sweep_tillage"};
static_assert(std::size(ids) == std::variant_size_v<TestConfig>);

/// A default config of every kind, in the order of TestConfig.
template <std::size_t... K>
std::vector<TestConfig> defaults(std::index_sequence<K...>) {
  return {TestConfig(std::in_place_index<K>)...};
}

std::vector<TestConfig> all_tests() {
  return defaults(std::make_index_sequence<std::variant_size_v<TestConfig>>());
}

/// The function that runs each kind of test.
template <class... F>
struct Runners : F... {
  using F::operator()...;
};

}  // namespace

const char* name_of(Fidelity fidelity) {
  switch (fidelity) {
    case Fidelity::preview: return "preview";
    case Fidelity::search: return "search";
    case Fidelity::confirm: return "confirm";
  }
  return "";
}

const char* test_id(const TestConfig& config) { return ids[config.index()]; }

std::vector<std::string> virtual_test_ids() { return {std::begin(ids), std::end(ids)}; }

TestConfig virtual_test(const std::string& id, Fidelity fidelity) {
  for (TestConfig test : all_tests()) {
    if (id != test_id(test)) continue;
    std::visit([fidelity](auto& c) { apply_fidelity(c, fidelity); }, test);
    return test;
  }
  const std::vector<std::string> known = virtual_test_ids();
  throw ConfigError({unknown_name_sentence("experiment", id, known)});
}

std::vector<Field> fields(TestConfig& config) {
  return std::visit([](auto& c) { return fields(c); }, config);
}

std::vector<std::string> problems(TestConfig config) {
  std::vector<std::string> found = range_problems(fields(config));
  const std::vector<std::string> own =
      std::visit([](const auto& c) { return own_problems(c); }, config);
  found.insert(found.end(), own.begin(), own.end());
  return found;
}

namespace {

/// Tracers lie on a grid of all depths and offsets, so that one pass of the tool serves many sites.
bool join_sweeps(SweepTillageConfig& a, const SweepTillageConfig& b) {
  SweepTillageConfig with_tracers_of_a = b;
  with_tracers_of_a.tracer_depth_m = a.tracer_depth_m;
  with_tracers_of_a.tracer_lateral_m = a.tracer_lateral_m;
  if (!same_values(a, with_tracers_of_a)) return false;
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    for (const double v : from)
      if (std::ranges::find(to, v) == to.end()) to.push_back(v);
    std::ranges::sort(to);
  };
  add(a.tracer_depth_m, b.tracer_depth_m);
  add(a.tracer_lateral_m, b.tracer_lateral_m);
  return true;
}

}  // namespace

bool join_series(TestConfig& series, const TestConfig& other) {
  if (same_values(series, other)) return true;
  if (auto* sweep = std::get_if<SweepTillageConfig>(&series))
    if (const auto* more = std::get_if<SweepTillageConfig>(&other)) return join_sweeps(*sweep, *more);
  auto* a = std::get_if<DrainedTriaxialConfig>(&series);
  const auto* b = std::get_if<DrainedTriaxialConfig>(&other);
  // A series of several cell pressures has features of its own and stays whole.
  if (!a || !b || b->cell_pressure_Pa.size() != 1 ||
      a->relative_density.empty() != b->relative_density.empty())
    return false;
  DrainedTriaxialConfig with_series_of_a = *b;
  with_series_of_a.cell_pressure_Pa = a->cell_pressure_Pa;
  with_series_of_a.relative_density = a->relative_density;
  if (!same_values(series, with_series_of_a)) return false;
  for (std::size_t k = 0; k < a->cell_pressure_Pa.size(); ++k) {
    const bool same_density =
        b->relative_density.empty() || a->relative_density[k] == b->relative_density.front();
    if (a->cell_pressure_Pa[k] == b->cell_pressure_Pa.front() && same_density) return true;
  }
  a->cell_pressure_Pa.push_back(b->cell_pressure_Pa.front());
  for (const double d : b->relative_density) a->relative_density.push_back(d);
  return true;
}

void set_packing_seed(TestConfig& config, std::uint64_t seed) {
  std::visit([seed](auto& c) { c.packing_seed = seed; }, config);
}

void apply_soil_state(TestConfig& config, const SoilData& soil) {
  auto* sweep = std::get_if<SweepTillageConfig>(&config);
  if (!sweep) return;
  if (const auto dry = state_value(soil, "dry_bulk_density_kg_per_m3"))
    sweep->bulk_density_kg_per_m3 = *dry * (1 + state_value(soil, "water_content_drained").value_or(0.0));
}

void apply_condition(TestConfig& config, const TestCondition& condition) {
  const std::vector<Field> settings = fields(config);
  for (const ConditionNumbers& given : condition.numbers)
    if (const Field* field = find_field(settings, given.column)) set_numbers(*field, given.values);
}

std::string feature_name(const SoilTarget& target, const TestCondition& condition) {
  const KnownObservable* known =
      soil_vocabulary().observable(target.test_id, target.observable_id);
  if (!known) return target.observable_id;
  if (known->need == ConditionNeed::one_normal_stress)
    return fmt::format("{}@{:.0f}", target.observable_id,
                       condition.number("normal_stress_Pa").value_or(0.0));
  if (known->need == ConditionNeed::one_cell_pressure)
    return fmt::format("{}@{}", target.observable_id,
                       triaxial_state_label(condition.number("cell_pressure_Pa").value_or(0.0),
                                            condition.number("relative_density")));
  const auto depth_m = condition.number("tracer_depth_m");
  const auto aside_m = condition.number("tracer_lateral_m");
  if (!known->needed_columns.empty() && known->needed_columns.front() == "tracer_depth_m" && depth_m && aside_m)
    return fmt::format("{}@{}", target.observable_id, tracer_label(*depth_m, *aside_m));
  return target.observable_id;
}

namespace {

std::vector<ExperimentResult> run_as_set_up(const TestConfig& config,
                                            std::span<const SoilMaterial> members,
                                            PackingStore& packings, const RunOptions& options) {
  return std::visit(
      Runners{
          [&](const UnconfinedCompressionConfig& c) { return run_unconfined_compression(members, c, packings, options); },
          [&](const DirectShearConfig& c) { return run_direct_shear(members, c, packings, options); },
          [&](const ConfinedCompressionConfig& c) { return run_confined_compression(members, c, packings, options); },
          [&](const DrainedTriaxialConfig& c) { return run_drained_triaxial(members, c, packings, options); },
          [&](const DirectTensionConfig& c) { return run_direct_tension(members, c, packings, options); },
          [&](const InterfaceShearConfig& c) { return run_interface_shear(members, c, packings, options); },
          [&](const ConePenetrationConfig& c) { return run_cone_penetration(members, c, packings, options); },
          [&](const VaneShearConfig& c) { return run_vane_shear(members, c, packings, options); },
          [&](const AngleOfReposeConfig& c) { return run_angle_of_repose(members, c, packings, options); },
          [&](const SweepTillageConfig& c) { return run_sweep_tillage(members, c, packings, options); }},
      config);
}

/// Members whose effects ask for one setup, as places in the list.
std::vector<std::vector<std::size_t>> setup_groups(std::span<const SoilMaterial> members) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto key = setup_key(members[k].effects);
    const auto own = std::ranges::find_if(
        groups, [&](const auto& g) { return setup_key(members[g.front()].effects) == key; });
    if (own == groups.end()) groups.push_back({k});
    else own->push_back(k);
  }
  return groups;
}

ExperimentResult not_possible(const std::vector<std::string>& problems) {
  ExperimentResult r;
  r.status = RunStatus::not_settled;
  r.message = fmt::format("its effects ask for an impossible setup: {}", problems.front());
  return r;
}

}  // namespace

void apply_setup_effects(TestConfig& config, SoilMaterial& material) {
  apply_setup_effects(test_id(config), fields(config), material.effects);
  material = on_day_of_test(test_id(config), material);
}

std::vector<ExperimentResult> run_virtual_test(const TestConfig& config,
                                               std::span<const SoilMaterial> members,
                                               PackingStore& packings, const RunOptions& options) {
  std::vector<ExperimentResult> results(members.size());
  for (const std::vector<std::size_t>& group : setup_groups(members)) {
    TestConfig own = config;
    std::vector<SoilMaterial> materials;
    for (const std::size_t k : group) {
      materials.push_back(members[k]);
      own = config;
      apply_setup_effects(own, materials.back());
    }
    const std::vector<std::string> wrong =
        same_values(own, config) ? std::vector<std::string>() : problems(own);
    std::vector<ExperimentResult> runs =
        wrong.empty() ? run_as_set_up(own, materials, packings, options)
                      : std::vector<ExperimentResult>(group.size(), not_possible(wrong));
    for (std::size_t m = 0; m < group.size(); ++m) {
      apply_measurement_effects(test_id(own), fields(own), members[group[m]].effects, runs[m]);
      results[group[m]] = std::move(runs[m]);
    }
  }
  return results;
}

}  // namespace tilth
