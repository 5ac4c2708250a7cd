// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/virtual_test.hpp"

#include <fmt/format.h>

#include "calibrate/config_error.hpp"
#include "calibrate/nearest_name.hpp"

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

void apply_fidelity(ConePenetrationConfig& c, Fidelity fidelity) {
  // Twice the grains: the chamber is wide for its cone. Speed as a multiple of the standard's 30 mm/s.
  c.num_particles = 2 * size_of(fidelity).num_particles;
  c.speed_m_per_s = 100 * size_of(fidelity).speed_over_wave_speed;
}

void apply_fidelity(VaneShearConfig& c, Fidelity fidelity) {
  c.num_particles = 2 * size_of(fidelity).num_particles;
  c.tip_speed_over_wave_speed = size_of(fidelity).speed_over_wave_speed;
}

std::vector<ExperimentResult> run(const UnconfinedCompressionConfig& c,
                                  std::span<const SoilMaterial> m, PackingStore& p,
                                  const RunOptions& o) {
  return run_unconfined_compression(m, c, p, o);
}
std::vector<ExperimentResult> run(const DirectShearConfig& c, std::span<const SoilMaterial> m,
                                  PackingStore& p, const RunOptions& o) {
  return run_direct_shear(m, c, p, o);
}
std::vector<ExperimentResult> run(const ConfinedCompressionConfig& c,
                                  std::span<const SoilMaterial> m, PackingStore& p,
                                  const RunOptions& o) {
  return run_confined_compression(m, c, p, o);
}
std::vector<ExperimentResult> run(const ConePenetrationConfig& c, std::span<const SoilMaterial> m,
                                  PackingStore& p, const RunOptions& o) {
  return run_cone_penetration(m, c, p, o);
}
std::vector<ExperimentResult> run(const VaneShearConfig& c, std::span<const SoilMaterial> m,
                                  PackingStore& p, const RunOptions& o) {
  return run_vane_shear(m, c, p, o);
}

const std::vector<TestConfig>& all_tests() {
  static const std::vector<TestConfig> tests = {
      UnconfinedCompressionConfig{}, DirectShearConfig{}, ConfinedCompressionConfig{},
      ConePenetrationConfig{}, VaneShearConfig{}};
  return tests;
}

}  // namespace

const char* test_id(const TestConfig& config) {
  constexpr const char* ids[] = {"unconfined_compression", "direct_shear", "confined_compression",
                                 "cone_penetration", "vane_shear"};
  return ids[config.index()];
}

std::vector<std::string> virtual_test_ids() {
  std::vector<std::string> ids;
  for (const TestConfig& t : all_tests()) ids.emplace_back(test_id(t));
  return ids;
}

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

void set_packing_seed(TestConfig& config, std::uint64_t seed) {
  std::visit([seed](auto& c) { c.packing_seed = seed; }, config);
}

void apply_condition(TestConfig& config, const TestCondition& condition) {
  const std::vector<Field> settings = fields(config);
  for (const ConditionNumbers& given : condition.numbers)
    if (const Field* field = find_field(settings, given.column)) set_numbers(*field, given.values);
}

std::string feature_name(const SoilTarget& target, const TestCondition& condition) {
  const KnownObservable* known =
      soil_vocabulary().observable(target.test_id, target.observable_id);
  const bool per_stress = known && known->need == ConditionNeed::one_normal_stress;
  const std::vector<double> stresses = condition.values("normal_stress_Pa");
  if (!per_stress || stresses.size() != 1) return target.observable_id;
  return fmt::format("{}@{:.0f}", target.observable_id, stresses.front());
}

std::vector<ExperimentResult> run_virtual_test(const TestConfig& config,
                                               std::span<const SoilMaterial> members,
                                               PackingStore& packings, const RunOptions& options) {
  return std::visit([&](const auto& c) { return run(c, members, packings, options); }, config);
}

}  // namespace tilth
