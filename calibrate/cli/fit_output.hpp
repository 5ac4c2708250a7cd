// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Curves and figures of a finished fit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/fit_summary.hpp"

namespace tilth {

struct FitCurves {
  std::vector<std::string> missing;           ///< and why, one sentence each
  std::vector<CurveSampleSize> sample_sizes;  ///< of measured curves beside the first rerun
};

/// Runs every planned test once more at the fitted values (search size on two packings, confirming
/// size on one; seeds no stage of the fit has used) and writes curves/*.csv and figures/*.svg.
FitCurves write_curves_and_figures(const SoilData& soil, const FitSummary& summary, Fidelity search,
                                   Fidelity confirm, std::uint64_t first_seed,
                                   const RunContext& context, const std::filesystem::path& folder);

/// How one kind of curve is drawn: which columns, in which human units.
struct CurveStyle {
  std::string x_label, y_label;
  std::size_t x_column = 0, y_column = 1;
  double x_scale = 1.0, y_scale = 1.0;
};
CurveStyle curve_style(const std::string& test_id);

}  // namespace tilth
