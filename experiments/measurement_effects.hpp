// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What instruments make of a test: changes of curves and features after the simulation.
#pragma once

#include <string_view>

#include "experiments/result.hpp"
#include "experiments/soil_effects.hpp"

namespace tilth {

/// Changes a completed result in place; nothing at the null values. `settings` give the specimen's height.
///
///   seating_compliance_m_per_Pa  C: strain + C stress / H in unconfined and confined compression, so that
///                                every secant modulus becomes 1 / (1/E + C/H)
///   shear_box_friction_Pa        shear stress + this, in direct shear
///   frame_load_gain              stress x (1 + g) in compression and tension; shear_box_load_gain: in direct
///                                and interface shear, friction angles atan((1 + g) tan); draught_load_gain:
///                                forces of a sweep
///
/// Triaxial tests stay as they are.
void apply_measurement_effects(std::string_view test_id, const std::vector<Field>& settings,
                               const SoilEffects& effects, ExperimentResult& result);

}  // namespace tilth
