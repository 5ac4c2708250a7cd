// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Whose targets a command works on: those of the element tests, of the soil bin, or of both.
#pragma once

#include <cstddef>
#include <string>

#include "calibrate/soil_data.hpp"

namespace tilth {

/// Leaves the targets of "mechanical" tests, of the "sweep" (draught, tracers), or "all".
/// @throws ConfigError if none is left to fit
void choose_tests(const std::string& tests, SoilData& soil);

/// For commands that take the sweep only when asked: leaves out its targets where the soil has others to fit.
/// @return how many were left out
std::size_t leave_out_sweep(SoilData& soil);

}  // namespace tilth
