// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Stress ratio and volumetric strain of triaxial tests, measured and simulated, side by side.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/soil_data.hpp"
#include "experiments/result.hpp"

namespace tilth {

/// What is drawn and compared of a triaxial curve: axial strain, stress ratio q/p, volumetric strain.
/// @param rows  with the columns of experiments/triaxial_features.hpp
Curve triaxial_curve(const std::vector<std::vector<double>>& rows);

/// One simulated curve with the columns of experiments/triaxial_features.hpp.
struct SimulatedTriaxial {
  std::string label;  ///< for the key: "simulated, confirm specimen"
  int color = 0;
  Curve curve;
};

/// Writes `<stem>_stress_ratio.svg` and `<stem>_volumetric_strain.svg`; the measured curve of the
/// condition, where there is one, is drawn with them.
/// @return why a figure is missing, one sentence each
std::vector<std::string> draw_triaxial(const SoilData& soil, const std::string& condition_id,
                                       bool holdout, const std::vector<SimulatedTriaxial>& simulated,
                                       const std::filesystem::path& stem);

}  // namespace tilth
