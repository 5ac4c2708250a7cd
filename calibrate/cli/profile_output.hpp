// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Profiles of a finished fit as tables and figures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/fit_summary.hpp"
#include "calibrate/soil_data.hpp"

namespace tilth {

/// One profile as CSV: the parameter, chi_square_difference, at_bound (name of another parameter at
/// its bound, or empty), then every other parameter; SI units, ties applied.
std::string profile_csv(const SoilData& soil, const ParameterProfile& profile);

/// Writes profiles/<parameter>.csv and figures/profile_<parameter>.svg for every profile.
/// @return what is missing and why, one sentence each
std::vector<std::string> write_profiles(const SoilData& soil, const FitSummary& summary,
                                        const std::filesystem::path& folder);

}  // namespace tilth
