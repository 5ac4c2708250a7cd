// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/fit_stages.hpp"

namespace tilth {
namespace {

constexpr double settled_shift = 0.1;  // standard errors

// Measures the bias at the optimum. False if no confirming run completed.
bool measure_bias(FitContext& context) {
  const Eigen::MatrixXd samples = repeat_optimum(context, *context.confirm, SeedUse::confirm,
                                                 context.options.num_confirm_seeds);
  if (samples.cols() == 0) return false;
  context.num_bias_seeds = static_cast<int>(samples.cols());
  context.confirm_variance = moderated_variance(samples, context.seed_variance);
  context.bias = samples.rowwise().mean() - context.optimum->mean;
  context.bias_error = (context.confirm_variance / context.num_bias_seeds +
                        context.seed_variance / context.optimum->num_seeds)
                           .cwiseSqrt();
  return true;
}

// Largest move of a parameter with an error bar, in its standard error.
double shift_in_errors(const FitContext& context, const Eigen::VectorXd& before) {
  double largest = 0.0;
  if (!context.uncertainty) return not_known;
  for (Eigen::Index j = 0; j < before.size(); ++j) {
    const double error = std::sqrt(context.uncertainty->covariance(j, j));
    if (!context.uncertainty->is_fixed(j) || error == 0.0) continue;
    largest = std::max(largest, std::abs(context.optimum->unit[j] - before[j]) / error);
  }
  return largest;
}

}  // namespace

void run_bias(FitContext& context) {
  if (!context.confirm || !context.optimum || !context.optimum->from_local_search) return;
  begin_stage(context.ledger, "bias");
  for (int round = 0; round < context.options.max_bias_rounds; ++round) {
    if (is_blocked(context.ledger)) return;
    if (!measure_bias(context)) {
      context.summary.warnings.emplace_back(
          "no confirming run completed: the search model was not corrected");
      return;
    }
    ++context.summary.num_bias_rounds;
    const Eigen::VectorXd before = context.optimum->unit;
    context.optimum->chi_square =
        fit_residuals(context, before, context.optimum->mean, context.optimum->num_seeds)
            .squaredNorm();
    context.optimum->converged = false;
    refit_from(context, before);
    update_uncertainty(context);
    context.summary.last_bias_shift = shift_in_errors(context, before);
    if (context.summary.last_bias_shift < settled_shift) return;
  }
  context.summary.warnings.push_back(
      fmt::format("the parameters still moved {:.2g} standard errors in the last bias round",
                  context.summary.last_bias_shift));
}

}  // namespace tilth
