// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <cmath>

#include "calibrate/fit_stages.hpp"

namespace tilth {
namespace {

// What the model says at the optimum, and how sure its mean is.
struct Prediction {
  Eigen::VectorXd mean;             // T, all targets
  Eigen::VectorXd variance;         // T, of the mean
  Eigen::VectorXd variance_of_one;  // T, of one simulation
};

Prediction predict(FitContext& context) {
  const Eigen::VectorXd& one =
      context.num_bias_seeds > 0 ? context.confirm_variance : context.seed_variance;
  const Optimum& optimum = *context.optimum;
  Evaluator& evaluator = context.num_bias_seeds > 0 ? *context.confirm : context.search;
  const Eigen::MatrixXd samples =
      repeat_optimum(context, evaluator, SeedUse::fresh, context.options.num_fresh_seeds);
  context.summary.num_fresh_seeds = static_cast<int>(samples.cols());
  if (samples.cols() > 0) {
    return {samples.rowwise().mean(), one / static_cast<double>(samples.cols()), one};
  }
  return {optimum.mean + context.bias, model_variance(context, optimum.num_seeds), one};
}

// T, from the covariance of the parameters: sqrt(diag(J C J')).
Eigen::VectorXd parameter_deviations(const FitContext& context,
                                     const std::optional<Secants>& secants) {
  const auto n = static_cast<Eigen::Index>(context.targets.size());
  if (!context.uncertainty || !secants) return Eigen::VectorXd::Constant(n, not_known);
  return propagated_deviation(secants->jacobian, context.uncertainty->covariance);
}

// Hold-outs with a simulator of their own: on the fresh seeds, and on the secants of the first.
void predict_holdouts(FitContext& context, Prediction& prediction, Eigen::VectorXd& parameter_sd) {
  const Eigen::MatrixXd samples = repeat_optimum(context, *context.holdout, SeedUse::fresh,
                                                 context.options.num_fresh_seeds);
  if (samples.cols() == 0) {
    context.summary.warnings.emplace_back("no run of the hold-outs completed");
    return;
  }
  const Eigen::VectorXd own_sd = parameter_deviations(
      context, derivatives_at(context, *context.holdout, context.optimum->unit,
                              stage_seeds(context.options, SeedUse::fresh, 1)));
  const Eigen::VectorXd variance = holdout_variance(context, samples, prediction.variance_of_one);
  for (std::size_t target = 0; target < context.targets.size(); ++target) {
    if (!context.targets[target].holdout) continue;
    const auto k = static_cast<Eigen::Index>(target);
    prediction.mean[k] = samples.row(k).mean();
    prediction.variance_of_one[k] = variance[k];
    prediction.variance[k] = variance[k] / static_cast<double>(samples.cols());
    parameter_sd[k] = own_sd[k];
  }
}

TargetResult compare(const FitContext& context, const Prediction& prediction,
                     const Eigen::VectorXd& parameter_sd, std::size_t target) {
  const Target& t = context.targets[target];
  const auto k = static_cast<Eigen::Index>(target);
  TargetResult result = compared(t, {prediction.mean[k], prediction.variance[k],
                                     prediction.variance_of_one[k], parameter_sd[k]});
  result.bias = std::isnan(context.bias[k]) ? 0.0 : context.bias[k];
  result.bias_error = context.bias_error[k];
  if (t.holdout) return result;
  set_reachability(context, target, result);
  if (const TargetConflict* conflict = context.summary.trend_conflict(t.name)) {
    result.reachability = Reachability::unreachable;
    result.conflicts_with = conflict->first == t.name ? conflict->second : conflict->first;
    result.joint_misfit = conflict->misfit;
  }
  return result;
}

}  // namespace

void run_fresh(FitContext& context) {
  if (!context.optimum) return;
  begin_stage(context.ledger, "fresh seeds");
  Prediction prediction = predict(context);
  Eigen::VectorXd parameter_sd = parameter_deviations(context, context.secants);
  if (context.holdout) predict_holdouts(context, prediction, parameter_sd);
  FitSummary& summary = context.summary;
  double fitted_sum = 0.0;
  double holdout_sum = 0.0;
  for (std::size_t k = 0; k < context.targets.size(); ++k) {
    const TargetResult result = compare(context, prediction, parameter_sd, k);
    const double square = result.residual * result.residual;
    (context.targets[k].holdout ? holdout_sum : fitted_sum) += square;
    (context.targets[k].holdout ? summary.holdouts : summary.targets).push_back(result);
  }
  if (summary.num_fresh_seeds > 0) summary.chi_square_fresh = fitted_sum;
  if (!summary.holdouts.empty()) {
    summary.holdout_rms = std::sqrt(holdout_sum / static_cast<double>(summary.holdouts.size()));
  }
}

}  // namespace tilth
