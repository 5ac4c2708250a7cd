// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/fit_stages.hpp"

namespace tilth {
namespace {

constexpr double normal_95 = 1.959963984540054;

// Covariance of the residuals at the optimum: 1 on the diagonal; between targets what one packing
// does to both; priors are independent.
Eigen::MatrixXd residual_covariance(const FitContext& context) {
  const int num_seeds = context.optimum->num_seeds;
  const Eigen::VectorXd sigmas = fitted_sigmas(context, num_seeds);
  const Eigen::VectorXd variance = model_variance(context, num_seeds);
  const Eigen::Index n = sigmas.size();
  const Eigen::Index total = n + static_cast<Eigen::Index>(num_priors(context));
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(total, total);
  Eigen::VectorXd share(n);  // of the packings in sigma_total
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(context.fitted[static_cast<std::size_t>(i)]);
    share[i] = std::sqrt(variance[k]) / sigmas[i];
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i != j) covariance(i, j) = context.seed_correlation(i, j) * share[i] * share[j];
    }
  }
  return covariance;
}

bool is_frozen(const FitContext& context, std::size_t j) {
  const auto& frozen = context.secants->frozen;
  return std::find(frozen.begin(), frozen.end(), j) != frozen.end();
}

std::string reason_without_error_bar(const FitContext& context, std::size_t j) {
  if (!context.optimum || !context.optimum->from_local_search) {
    return "no local search was completed";
  }
  if (!context.uncertainty) return "the runs around the optimum could not be had";
  if (is_frozen(context, j)) return "the runs on both sides of it failed";
  if (context.uncertainty->null_share[static_cast<Eigen::Index>(j)] > max_null_share) {
    return "the data do not fix it, see the null directions";
  }
  return "";
}

// Interval in the coordinate, back to physical, clipped at the bounds.
void set_interval(const Parameter& p, double unit_error, FittedParameter& fitted) {
  fitted.standard_error = unit_error * coordinate_span(p);
  const double centre = coordinate_from_physical(p, fitted.value);
  const double half_width = normal_95 * fitted.standard_error;
  const double low = physical_from_coordinate(p, centre - half_width);
  const double high = physical_from_coordinate(p, centre + half_width);
  fitted.lo95 = std::max(low, p.lower);
  fitted.hi95 = std::min(high, p.upper);
  const bool is_cut = low < p.lower || high > p.upper;
  fitted.verdict = is_cut ? ParameterVerdict::bound_limited : ParameterVerdict::identified;
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
    set_interval(p, std::sqrt(context.uncertainty->covariance(index, index)), fitted);
  } else if (context.uncertainty) {
    fitted.verdict = is_frozen(context, j) ? ParameterVerdict::unknown : ParameterVerdict::flat;
  }
  warn_about_value(context, fitted);
  context.summary.parameters.push_back(fitted);
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
        return context.uncertainty->null_share[k] <= max_null_share &&
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
    summary.null_directions.push_back(describe_null_direction(context.parameters, direction));
  }
}

}  // namespace

void update_uncertainty(FitContext& context) {
  context.secants.reset();
  context.uncertainty.reset();
  if (!context.optimum || !context.optimum->from_local_search) return;
  const Eigen::VectorXd steps =
      secant_steps(context.parameters, context.options.log_step, context.options.linear_step);
  context.secants = paired_secants(
      context.search, context.parameters, context.targets, context.optimum->unit, steps,
      stage_seeds(context.options, SeedUse::search, context.options.num_search_seeds));
  if (!context.secants) return;
  context.uncertainty = linear_uncertainty(
      residual_jacobian(context, context.secants->jacobian, context.optimum->num_seeds),
      residual_covariance(context));
}

void report_parameters(FitContext& context) {
  std::size_t next_free = 0;
  for (std::size_t i = 0; i < context.parameters.size(); ++i) report_one(context, i, next_free);
  if (context.uncertainty) report_covariance(context);
}

}  // namespace tilth
