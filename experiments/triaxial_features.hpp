// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Named numbers of a drained triaxial curve, read the same way from a measured and a simulated one.
#pragma once

#include "experiments/result.hpp"

namespace tilth {

/// Columns of a triaxial curve, in this order: strains since the start of shearing, compression
/// positive (negative volumetric strain is dilation); effective stresses.
inline const std::vector<std::string> triaxial_columns = {"axial_strain", "volumetric_strain",
                                                          "axial_stress_Pa", "radial_stress_Pa"};

/// With q = axial - radial stress, p = (axial + 2 radial) / 3, eta = q / p:
///
/// - initial_modulus_Pa: (q(0.5 %) - q(first row)) / 0.005, q interpolated
/// - peak_stress_ratio: largest eta, averaged over rows within 0.5 % of strain either side;
///   strain_at_peak where it stands
/// - end_stress_ratio: mean eta of the last 2 % of strain
/// - dilation_rate: largest - d(volumetric strain) / d(axial strain), least-squares slope of the rows
///   within 1 % either side
/// - final_volumetric_strain: of the last row
/// @source the modulus as the secant over 0.5 % is own choice; the averages keep the scatter of a few
///         hundred grains from being read as a peak
/// @return empty when the curve ends before 4 % or has fewer than 10 rows
std::vector<Feature> triaxial_features(const Curve& curve);

}  // namespace tilth
