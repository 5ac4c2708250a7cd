// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Figures of a sensitivity study, one per feature.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/sensitivity_report.hpp"

namespace tilth {

/// Morris: the plane of mu_star and sigma with intervals, the line sigma = mu_star and the noise
/// floor of mu_star; level count in the title. Sobol: bars of S and ST with intervals and bounds,
/// and the packing noise beside them. Emulated and PREVIEW figures say so in the title.
/// @return empty, or why there is no figure
std::string draw_feature(const SensitivitySummary& summary, const FeatureSensitivity& feature,
                         const SensitivityContext& context, const std::filesystem::path& svg);

/// figures/<method>_<feature>.svg for every feature that has indices. @return reasons of those
/// missing
std::vector<std::string> draw_sensitivity(const SensitivitySummary& summary,
                                          const SensitivityContext& context,
                                          const std::filesystem::path& run_folder);

}  // namespace tilth
