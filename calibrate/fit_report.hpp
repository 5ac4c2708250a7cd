// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The human report of a fit, in the layout of lmfit plus the lines its users miss.
#pragma once

#include <string>

#include "calibrate/fit_summary.hpp"

namespace tilth {

/// What the report says that the summary does not know.
struct ReportContext {
  std::string first_line;  ///< "share of measured targets: ..."; printed first
};

/// Sections [[Fit Statistics]], [[Gates]], [[Warnings]], [[Variables]], [[Correlations]],
/// [[Null directions]], [[Targets]], [[Bias]], [[Hold-out]]; physical values in SI units.
/// No error bar is printed without its meaning, none is left out without the reason.
std::string fit_report_text(const FitSummary& summary, const ReportContext& context);

}  // namespace tilth
