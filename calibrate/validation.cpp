// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/validation.hpp"

#include <cmath>
#include <limits>

#include "calibrate/secants.hpp"
#include "calibrate/seed_average.hpp"
#include "calibrate/uncertainty.hpp"

namespace tilth {
namespace {

/// sqrt(diag(J C J')) in T; NaN where there is no covariance or the runs around the set failed.
Eigen::VectorXd deviation_by_parameters(Evaluator& evaluator, const ValidationProblem& problem,
                                        const Eigen::VectorXd& unit) {
  const auto n = static_cast<Eigen::Index>(problem.targets.size());
  if (problem.covariance.size() == 0) return Eigen::VectorXd::Constant(n, not_known);
  const auto secants = paired_secants(
      evaluator, problem.parameters, problem.targets, unit,
      secant_steps(problem.parameters, problem.options.log_step, problem.options.linear_step),
      std::span(problem.seeds).first(1));
  if (!secants) return Eigen::VectorXd::Constant(n, not_known);
  Eigen::VectorXd inverse_spans(unit.size());
  const std::vector<std::size_t> free = free_parameters(problem.parameters);
  for (std::size_t j = 0; j < free.size(); ++j)
    inverse_spans[static_cast<Eigen::Index>(j)] = 1.0 / coordinate_span(problem.parameters[free[j]]);
  return propagated_deviation(secants->jacobian * inverse_spans.asDiagonal(), problem.covariance);
}

TargetPrediction prediction_of(const Eigen::RowVectorXd& values, double parameter_sd) {
  const auto n = static_cast<double>(values.size());
  const double mean = values.mean();
  const double variance = n > 1 ? (values.array() - mean).square().sum() / (n - 1) : not_known;
  return {mean, n > 1 ? variance / n : 0.0, variance, parameter_sd};
}

}  // namespace

Validation validate(const ValidationProblem& problem, const Simulator& simulator) {
  SimulationLedger ledger;
  ledger.max_simulations = std::numeric_limits<std::size_t>::max();
  ledger.should_stop = problem.should_stop;
  begin_stage(ledger, "validation");
  std::vector<Target> targets = problem.targets;
  for (Target& t : targets) t.holdout = true;
  Evaluator evaluator(simulator, targets, "validation", ledger, TargetScope::holdouts);
  const Eigen::VectorXd unit = unit_start(problem.parameters);

  Validation v;
  v.limit = problem.limit;
  const Eigen::MatrixXd samples =
      samples_over_seeds(evaluator, problem.parameters, targets, unit, problem.seeds);
  v.num_seeds = static_cast<int>(samples.cols());
  double sum = 0.0;
  if (v.num_seeds > 0) {
    const Eigen::VectorXd by_parameters = deviation_by_parameters(evaluator, problem, unit);
    v.has_parameter_errors = by_parameters.array().isFinite().any();
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      v.targets.push_back(compared(targets[k], prediction_of(samples.row(row), by_parameters[row])));
      sum += v.targets.back().residual * v.targets.back().residual;
    }
  }
  if (!v.targets.empty()) v.rms = std::sqrt(sum / static_cast<double>(v.targets.size()));
  v.num_simulations = ledger.num_done;
  v.failures = ledger.failures;
  v.stopped = ledger.stop_seen;
  return v;
}

}  // namespace tilth
