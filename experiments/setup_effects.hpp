// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Effects that change how a virtual test is set up: numerical candidates, density, depth, drying.
#pragma once

#include <array>
#include <string_view>

#include "experiments/material.hpp"

namespace tilth {

/// The numbers that change a config: members whose key is equal can share packings and packs.
std::array<double, 5> setup_key(const SoilEffects& effects);

/// Changes the settings of a test in place; nothing at the null values.
///
///   porosity_offset        porosity + offset, at the same grain size and density of the grains
///   particle_size_change   grain diameter x (1 + change), in the same specimen
///   loading_rate_change    numerical speeds x (1 + change); the speed of a sweep is physical and stays
///   domain_size_change     lengths of the specimen x (1 + change), at the same grain size and tool
///   tool_depth_offset_m    a sweep runs that much deeper than it is said to
void apply_setup_effects(std::string_view test_id, const std::vector<Field>& settings,
                         const SoilEffects& effects);

/// Day of a test in a series of laboratory and field work: compression tests first, then shear and
/// tension, then cone, vane and sweep. Our choice.
int day_of_test(std::string_view test_id);

/// The material as it is on the day of a test: bond strengths x (1 + strength_drift x day).
SoilMaterial on_day_of_test(std::string_view test_id, SoilMaterial material);

}  // namespace tilth
