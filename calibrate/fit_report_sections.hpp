// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Private to the fit report: how it writes lines and numbers, and its sections about parameters.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "calibrate/fit_summary.hpp"

namespace tilth {

template <typename... Arguments>
void report_line(std::string& text, fmt::format_string<Arguments...> format,
                 Arguments&&... arguments) {
  text += "    ";
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
  text += '\n';
}

/// Six digits, three digits; "-" for NaN.
inline std::string report_number(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.6g}", value);
}
inline std::string short_report_number(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

/// [[Variables]]: one line each, then a table of intervals and of where the errors come from.
void report_variables(const FitSummary& summary, std::string& text);
/// [[Correlations]], largest first.
void report_correlations(const FitSummary& summary, std::string& text);
/// [[Null directions]], fixed by nothing, then those barely fixed.
void report_null_directions(const FitSummary& summary, std::string& text);

}  // namespace tilth
