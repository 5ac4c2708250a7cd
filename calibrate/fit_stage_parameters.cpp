// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "calibrate/fit_stages.hpp"
#include "calibrate/student_t.hpp"

namespace tilth {
namespace {

// Longer error bars than this times the one with all others held are warned about.
constexpr double large_inflation = 100.0;
// So are error bars that the noise of the derivatives makes longer than this times.
constexpr double large_noise_factor = 1.25;

bool is_frozen(const FitContext& context, std::size_t j) {
  const auto& frozen = context.secants->frozen;
  return std::find(frozen.begin(), frozen.end(), j) != frozen.end();
}

std::string reason_without_error_bar(const FitContext& context, std::size_t j) {
  if (!context.optimum || !context.optimum->from_local_search) {
    return "no local search was completed";
  }
  if (context.options.rescale_sigma && degrees_of_freedom(context) < 1) {
    return "sigma is to be rescaled, but there are no degrees of freedom";
  }
  if (!context.uncertainty) return "the runs around the optimum could not be had";
  if (is_frozen(context, j)) return "the runs on both sides of it failed";
  if (!context.uncertainty->is_fixed(static_cast<Eigen::Index>(j))) {
    return context.uncertainty->num_drowned > 0
               ? "its derivatives drown in the scatter of neighbouring runs; the profile says what is known"
               : "the data do not fix it, see the null directions";
  }
  return "";
}

// Interval in the coordinate, back to physical, clipped at the bounds.
void set_interval(const Parameter& p, double factor, FittedParameter& fitted) {
  const double centre = coordinate_from_physical(p, fitted.value);
  const double half_width = factor * fitted.standard_error;
  const double low = physical_from_coordinate(p, centre - half_width);
  const double high = physical_from_coordinate(p, centre + half_width);
  fitted.lo95 = std::max(low, p.lower);
  fitted.hi95 = std::min(high, p.upper);
  const int num_cut = (low < p.lower ? 1 : 0) + (high > p.upper ? 1 : 0);
  fitted.verdict = num_cut == 0   ? ParameterVerdict::identified
                   : num_cut == 1 ? ParameterVerdict::one_sided
                                  : ParameterVerdict::flat;
}

// Standard error, its two parts, and how much the other parameters lengthen it.
void set_errors(const FitContext& context, const Parameter& p, Eigen::Index j,
                FittedParameter& fitted) {
  const double span = coordinate_span(p);
  const double unit_error = std::sqrt(context.uncertainty->covariance(j, j));
  fitted.standard_error = unit_error * span;
  fitted.standard_error_targets = errors_from_targets(context)[j] * span;
  fitted.standard_error_packings = errors_from_packings(context)[j] * span;
  const Eigen::MatrixXd jacobian =
      residual_jacobian(context, context.secants->jacobian, context.optimum->num_seeds);
  fitted.inflation = unit_error * jacobian.col(j).norm() / sigma_scale(context);
}

void warn_about_value(FitContext& context, const FittedParameter& fitted) {
  auto& warnings = context.summary.warnings;
  if (fitted.value <= fitted.lower || fitted.value >= fitted.upper) {
    warnings.push_back(fmt::format("{} is at its bound {:.6g}", fitted.name, fitted.value));
  }
  if (fitted.value == fitted.start) {
    warnings.push_back(fmt::format("{} is at its initial value", fitted.name));
  }
  if (!fitted.no_error_bar.empty()) {
    warnings.push_back(
        fmt::format("no error bar for {} because {}", fitted.name, fitted.no_error_bar));
  }
}

void warn_about_noise(FitContext& context) {
  const LinearUncertainty& u = *context.uncertainty;
  std::string names;
  std::size_t j = 0;
  for (const FittedParameter& p : context.summary.parameters) {
    if (!p.estimate) continue;
    const double factor = u.noise_factor[static_cast<Eigen::Index>(j++)];
    if (!p.no_error_bar.empty() || !(factor > large_noise_factor)) continue;
    names += fmt::format("{}{} ({:.2g} times)", names.empty() ? "" : ", ", p.name, factor);
  }
  const std::string remedy = "more packings (num_search_seeds) would make up for it";
  if (!names.empty()) {
    context.summary.warnings.push_back(fmt::format(
        "neighbouring runs scatter so much that derivatives are uncertain, which lengthens the error bar of {}; {}",
        names, remedy));
  }
  if (u.num_drowned > 0) {
    context.summary.warnings.push_back(
        fmt::format("the scatter of neighbouring runs alone explains the derivatives along {} of the null "
                    "directions; {}", u.num_drowned, remedy));
  }
}

void report_one(FitContext& context, std::size_t i, std::size_t& next_free) {
  const Parameter& p = context.parameters[i];
  FittedParameter fitted;
  fitted.name = p.name;
  fitted.start = fitted.value = p.start;
  fitted.lower = p.lower;
  fitted.upper = p.upper;
  fitted.log_scale = p.log_scale;
  fitted.estimate = p.estimate;
  if (!p.estimate) {
    fitted.verdict = ParameterVerdict::fixed;
    context.summary.parameters.push_back(fitted);
    return;
  }
  const std::size_t j = next_free++;
  const auto index = static_cast<Eigen::Index>(j);
  if (context.optimum) fitted.value = physical_from_unit(p, context.optimum->unit[index]);
  fitted.no_error_bar = reason_without_error_bar(context, j);
  if (fitted.no_error_bar.empty()) {
    set_errors(context, p, index, fitted);
    set_interval(p, context.summary.interval_factor, fitted);
  } else if (context.uncertainty) {
    fitted.verdict = is_frozen(context, j) ? ParameterVerdict::unknown : ParameterVerdict::flat;
  }
  set_profile_verdict(context, j, fitted);
  warn_about_value(context, fitted);
  context.summary.parameters.push_back(fitted);
}

// A direction that is fixed in principle, but so badly that error bars rest on the last digits.
void report_near_null_direction(FitContext& context) {
  std::string names;
  for (const FittedParameter& p : context.summary.parameters) {
    if (!(p.inflation > large_inflation)) continue;
    names += fmt::format("{}{} ({:.0f} times)", names.empty() ? "" : ", ", p.name, p.inflation);
  }
  if (names.empty()) return;
  context.summary.warnings.push_back(
      fmt::format("nearly unidentifiable: {}; in brackets, how much longer the error bar is than "
                  "with all other "
                  "parameters held",
                  names));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(context.uncertainty->covariance);
  const Eigen::VectorXd weakest = solver.eigenvectors().rightCols(1);
  context.summary.near_null_directions.push_back("the data barely fix " +
                                                 describe_direction(context.parameters, weakest));
}

// Covariance to the coordinate; correlations where both parameters have an error bar.
void report_covariance(FitContext& context) {
  const auto q = static_cast<Eigen::Index>(context.free.size());
  Eigen::VectorXd spans(q);
  for (Eigen::Index j = 0; j < q; ++j) {
    spans[j] = coordinate_span(context.parameters[context.free[static_cast<std::size_t>(j)]]);
  }
  FitSummary& summary = context.summary;
  summary.covariance = spans.asDiagonal() * context.uncertainty->covariance * spans.asDiagonal();
  summary.correlation = Eigen::MatrixXd::Constant(q, q, not_known);
  for (Eigen::Index i = 0; i < q; ++i) {
    for (Eigen::Index j = 0; j < q; ++j) {
      const auto has_bar = [&](Eigen::Index k) {
        return context.uncertainty->is_fixed(k) &&
               !is_frozen(context, static_cast<std::size_t>(k));
      };
      if (!has_bar(i) || !has_bar(j)) continue;
      summary.correlation(i, j) =
          summary.covariance(i, j) / std::sqrt(summary.covariance(i, i) * summary.covariance(j, j));
    }
  }
  for (Eigen::Index column = 0; column < context.uncertainty->null_space.cols(); ++column) {
    Eigen::VectorXd direction = context.uncertainty->null_space.col(column);
    // A frozen parameter is not flat, only unknown.
    for (const std::size_t j : context.secants->frozen) direction[static_cast<Eigen::Index>(j)] = 0;
    if (direction.norm() < 0.5) continue;
    summary.null_directions.push_back(
        context.uncertainty->num_drowned > 0
            ? "the derivatives do not resolve " + describe_direction(context.parameters, direction)
            : describe_null_direction(context.parameters, direction));
  }
}

}  // namespace

void report_parameters(FitContext& context) {
  FitSummary& summary = context.summary;
  summary.sigma_is_rescaled = context.options.rescale_sigma;
  summary.sigma_scale = context.optimum ? sigma_scale(context) : not_known;
  if (summary.sigma_is_rescaled && degrees_of_freedom(context) > 0) {
    summary.interval_factor = student_t_half_width(0.95, degrees_of_freedom(context));
  }
  std::size_t next_free = 0;
  for (std::size_t i = 0; i < context.parameters.size(); ++i) report_one(context, i, next_free);
  if (!context.uncertainty) return;
  warn_about_noise(context);
  report_covariance(context);
  report_near_null_direction(context);
}

}  // namespace tilth
