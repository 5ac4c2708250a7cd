// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/extrapolated_derivatives.hpp"
#include "calibrate/fit_stages.hpp"

namespace tilth {

std::optional<Secants> derivatives_at(const FitContext& context, Evaluator& evaluator,
                                      const Eigen::VectorXd& unit,
                                      std::span<const std::uint64_t> seeds) {
  const FitOptions& options = context.options;
  if (options.derivatives == DerivativeRule::extrapolated) {
    return extrapolated_derivatives(evaluator, context.parameters, context.targets, unit, seeds);
  }
  const Eigen::VectorXd steps =
      secant_steps(context.parameters, options.log_step, options.linear_step);
  return paired_secants(evaluator, context.parameters, context.targets, unit, steps, seeds);
}

double derivative_error_share(const FitOptions& options) {
  return options.derivatives == DerivativeRule::extrapolated ? 1e-10 : 1e-3;
}

}  // namespace tilth
