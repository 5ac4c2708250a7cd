// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Named features of the measured curves of a soil, with sigmas, as rows of measurements.csv.
#pragma once

#include <string>
#include <vector>

#include "calibrate/soil_data.hpp"

namespace tilth {

/// Rows for every drained triaxial curve of the soil, read by the code that reads the simulated ones
/// (experiments/triaxial_features.hpp).
///
/// There are no repeats, so sigma is the scatter of a feature about the regression
///   y = b0 + b1 I_D + b2 I_D^2 + b3 ln(cell pressure)
/// over all curves, y = ln of the modulus (sigma_kind log), the feature itself for the others
/// (absolute). A peak in the last 1 % of strain is where the test ended: its strain is left out, and
/// its peak and end ratio, the same number, share an observation group.
/// @param fitted  condition ids whose rows are fitted; the others are held out
/// @throws ConfigError naming what is missing: curves, relative densities, unknown condition ids
std::vector<SoilTarget> features_of_curves(const SoilData& soil,
                                           const std::vector<std::string>& fitted,
                                           const std::string& source);

/// measurements.csv with a header line.
std::string measurements_csv(const std::vector<SoilTarget>& targets);

}  // namespace tilth
