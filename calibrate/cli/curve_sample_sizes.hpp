// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// How many independent values the misfit of a measured curve is worth.
#pragma once

#include <vector>

#include "calibrate/fit_summary.hpp"
#include "calibrate/soil_data.hpp"
#include "experiments/result.hpp"

namespace tilth {

/// Effective sample sizes of a measured triaxial curve, one for its stress ratio q/p and one for its
/// volumetric strain: of the series
///   simulated(strain_i) - measured_i
/// at the measured strains the simulated curve reaches, the latter interpolated. The misfit is taken and
/// not the curve, whose rise is no correlation of errors. Its neighbours are alike both because the model
/// is wrong in one way over a whole stretch and because a packing is; readings beyond this number
/// tell a fit nothing new, which is why a curve enters as a few features (`calibrate features`).
/// @param simulated  columns of experiments/triaxial_features.hpp, rows in order of strain
std::vector<CurveSampleSize> curve_sample_sizes(const MeasuredCurve& measured, const Curve& simulated);

}  // namespace tilth
