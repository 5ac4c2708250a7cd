// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <tuple>
#include <vector>

#include "calibrate/fit_report_sections.hpp"

namespace tilth {
namespace {

constexpr double smallest_reported_correlation = 0.1;
constexpr double notable_difference = 0.1;  // of the linear interval

// A standard error in the physical unit; on a log scale that of the tangent, value * se.
double physical_error(const FittedParameter& p, double error) {
  return p.log_scale ? p.value * error : error;
}

std::string error_words(const FittedParameter& p) {
  if (!p.no_error_bar.empty()) return fmt::format("no error bar because {}", p.no_error_bar);
  const double error = physical_error(p, p.standard_error);
  const std::string percent =
      p.value != 0.0 ? fmt::format(" ({:.2f}%)", 100.0 * error / std::abs(p.value)) : "";
  return fmt::format("+/- {}{}", short_report_number(error), percent);
}

std::string interval_words(double low, double high) {
  const auto end = [](double v) { return std::isnan(v) ? "-" : fmt::format("{:.4g}", v); };
  return fmt::format("[{}, {}]", end(low), end(high));
}

// Does an end of the profile interval lie elsewhere, in the coordinate? One that is not reached
// stands for the bound.
bool differs(const FittedParameter& p) {
  const auto coordinate = [&](double v) { return p.log_scale ? std::log(v) : v; };
  const double low = std::isnan(p.profile_lo95) ? p.lower : p.profile_lo95;
  const double high = std::isnan(p.profile_hi95) ? p.upper : p.profile_hi95;
  const double allowed = notable_difference * (coordinate(p.hi95) - coordinate(p.lo95));
  return !(std::abs(coordinate(low) - coordinate(p.lo95)) <= allowed) ||
         !(std::abs(coordinate(high) - coordinate(p.hi95)) <= allowed);
}

std::size_t name_width(const FitSummary& s) {
  std::size_t width = 0;
  for (const FittedParameter& p : s.parameters) width = std::max(width, p.name.size());
  return width;
}

// 95 % intervals of both kinds, and the two parts of each standard error.
void interval_table(const FitSummary& s, std::string& text) {
  const std::size_t width = std::max<std::size_t>(name_width(s), 14);
  text += '\n';
  report_line(text, "{:<{}} {:<26} {:<28} {:>15} {:>15}", "95 % intervals", width, "linear",
              s.profiles.empty() ? "profile: none" : "profile", "se from targets", "from packings");
  bool any_differs = false;
  for (const FittedParameter& p : s.parameters) {
    if (!p.estimate || !p.expression.empty()) continue;
    const bool marked = !s.profiles.empty() && differs(p);
    any_differs = any_differs || marked;
    const std::string profile =
        s.profiles.empty() ? ""
                           : interval_words(p.profile_lo95, p.profile_hi95) + (marked ? " *" : "");
    report_line(text, "{:<{}} {:<26} {:<28} {:>15} {:>15}", p.name, width,
                interval_words(p.lo95, p.hi95), profile,
                short_report_number(physical_error(p, p.standard_error_targets)),
                short_report_number(physical_error(p, p.standard_error_packings)));
  }
  if (!s.profiles.empty()) {
    report_line(
        text, "\"-\": the 95 % level is not reached inside the bounds; verdicts go by the profile");
  }
  if (any_differs)
    report_line(text, "*: an end differs by more than a tenth of the linear interval");
}

}  // namespace

void report_variables(const FitSummary& s, std::string& text) {
  text += "[[Variables]]\n";
  const std::size_t width = name_width(s) + 1;
  bool any_free = false;
  for (const FittedParameter& p : s.parameters) {
    const std::string name = p.name + ":";
    if (!p.expression.empty()) {
      report_line(text, "{:<{}} {} == '{}'", name, width, report_number(p.value), p.expression);
    } else if (p.verdict == ParameterVerdict::fixed) {
      report_line(text, "{:<{}} {} (fixed)", name, width, report_number(p.value));
    } else {
      any_free = true;
      report_line(text, "{:<{}} {} {} (init = {})  {}", name, width, report_number(p.value),
                  error_words(p), report_number(p.start), verdict_words(p));
    }
  }
  if (any_free) interval_table(s, text);
}

void report_correlations(const FitSummary& s, std::string& text) {
  text += fmt::format("[[Correlations]] (unreported correlations are < {:.3f})\n",
                      smallest_reported_correlation);
  std::vector<const FittedParameter*> free;
  for (const FittedParameter& p : s.parameters) {
    if (p.estimate) free.push_back(&p);
  }
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (Eigen::Index i = 0; i < s.correlation.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < s.correlation.cols(); ++j) {
      const double c = s.correlation(i, j);
      if (std::abs(c) >= smallest_reported_correlation) {
        pairs.emplace_back(c, static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      }
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return std::abs(std::get<0>(a)) > std::abs(std::get<0>(b));
  });
  for (const auto& [c, i, j] : pairs) {
    report_line(text, "C({}, {}) = {:+.{}f}", free[i]->name, free[j]->name, c,
                std::abs(c) > 0.9995 ? 7 : 4);
  }
  if (s.covariance.size() == 0) report_line(text, "not known: there is no covariance");
}

void report_null_directions(const FitSummary& s, std::string& text) {
  text += "[[Null directions]]\n";
  for (const std::string& words : s.null_directions) report_line(text, "{}", words);
  for (const std::string& words : s.near_null_directions) report_line(text, "{}", words);
  if (s.null_directions.empty() && s.near_null_directions.empty()) {
    report_line(text, "{}",
                s.covariance.size() == 0 ? "not known: there is no covariance" : "none");
  }
}

}  // namespace tilth
