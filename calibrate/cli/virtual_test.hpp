// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The virtual tests by name: the one list that fit, simulate and check share.
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calibrate/soil_data.hpp"
#include "experiments/angle_of_repose.hpp"
#include "experiments/cone_penetration.hpp"
#include "experiments/confined_compression.hpp"
#include "experiments/direct_shear.hpp"
#include "experiments/direct_tension.hpp"
#include "experiments/drained_triaxial.hpp"
#include "experiments/interface_shear.hpp"
#include "experiments/sweep_tillage.hpp"
#include "experiments/unconfined_compression.hpp"
#include "experiments/vane_shear.hpp"

namespace tilth {

using TestConfig =
    std::variant<UnconfinedCompressionConfig, DirectShearConfig, ConfinedCompressionConfig,
                 DrainedTriaxialConfig, DirectTensionConfig, InterfaceShearConfig,
                 ConePenetrationConfig, VaneShearConfig, AngleOfReposeConfig, SweepTillageConfig>;

/// How large and how slow: `search` finds, `confirm` is believed.
enum class Fidelity {
  preview,  ///< about 300 spheres, very fast: --quick
  search,   ///< about 500 spheres, fast
  confirm   ///< about 1500 spheres, slow
};

/// "preview", "search", "confirm"
const char* name_of(Fidelity fidelity);

/// "unconfined_compression", "direct_shear", ...
std::vector<std::string> virtual_test_ids();

/// Default config of a test at a fidelity. @throws ConfigError naming the known tests
TestConfig virtual_test(const std::string& test_id, Fidelity fidelity);

const char* test_id(const TestConfig& config);

std::vector<Field> fields(TestConfig& config);

/// Everything a test cannot be run with: ranges, and what its own numbers contradict.
std::vector<std::string> problems(TestConfig config);

/// Adds the states of `other` to a series that runs in the same packs: triaxial tests that differ in
/// cell pressure and relative density only, sweeps that differ in their tracers only. False where the
/// two are not of one series.
bool join_series(TestConfig& series, const TestConfig& other);

void set_packing_seed(TestConfig& config, std::uint64_t seed);

/// Takes what a test of a bed needs from the state of the soil: the bulk density as it lies, dry density
/// x (1 + water content), where soil.json has both; the dry one where it has no water content.
void apply_soil_state(TestConfig& config, const SoilData& soil);

/// Takes normal stresses and load stresses of a condition over into the config.
void apply_condition(TestConfig& config, const TestCondition& condition);

/// Name of the feature that answers a target: direct shear stresses carry "@<normal stress>", tracer
/// displacements "@<depth>m_<offset>m".
std::string feature_name(const SoilTarget& target, const TestCondition& condition);

/// What the material's effects change before the test: settings, and the material on that day.
void apply_setup_effects(TestConfig& config, SoilMaterial& material);

/// One result per member, with all that its effects do to setup, soil and measurement.
std::vector<ExperimentResult> run_virtual_test(const TestConfig& config,
                                               std::span<const SoilMaterial> members,
                                               PackingStore& packings, const RunOptions& options);

}  // namespace tilth
