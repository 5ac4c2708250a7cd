// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/validation.hpp"

#include <cmath>
#include <limits>

#include "calibrate/secants.hpp"
#include "calibrate/seed_average.hpp"

namespace tilth {
namespace {

/// T of every target on every completed packing. @shape (num_targets, num_completed)
Eigen::MatrixXd samples_at(Evaluator& evaluator, const ValidationProblem& problem,
                           const Eigen::VectorXd& unit) {
  const Eigen::MatrixXd points =
      physical_point(problem.parameters, unit).replicate(1, static_cast<Eigen::Index>(problem.seeds.size()));
  Eigen::MatrixXd samples(static_cast<Eigen::Index>(problem.targets.size()), 0);
  for (const Evaluation& run : evaluator.evaluate(points, problem.seeds)) {
    if (run.status != EvaluationStatus::completed) continue;
    samples.conservativeResize(Eigen::NoChange, samples.cols() + 1);
    samples.rightCols(1) = transformed_features(problem.targets, run);
  }
  return samples;
}

/// sqrt(diag(J C J')) in T; zero where there is no covariance or the runs around the set failed.
Eigen::VectorXd deviation_by_parameters(Evaluator& evaluator, const ValidationProblem& problem,
                                        const Eigen::VectorXd& unit, bool& known) {
  const auto n = static_cast<Eigen::Index>(problem.targets.size());
  known = false;
  if (problem.covariance.size() == 0) return Eigen::VectorXd::Zero(n);
  const auto secants = paired_secants(
      evaluator, problem.parameters, problem.targets, unit,
      secant_steps(problem.parameters, problem.options.log_step, problem.options.linear_step),
      std::span(problem.seeds).first(1));
  if (!secants) return Eigen::VectorXd::Zero(n);
  Eigen::VectorXd inverse_spans(unit.size());
  const std::vector<std::size_t> free = free_parameters(problem.parameters);
  for (std::size_t j = 0; j < free.size(); ++j)
    inverse_spans[static_cast<Eigen::Index>(j)] = 1.0 / coordinate_span(problem.parameters[free[j]]);
  const Eigen::MatrixXd jacobian = secants->jacobian * inverse_spans.asDiagonal();
  known = true;
  return (jacobian * problem.covariance).cwiseProduct(jacobian).rowwise().sum().cwiseMax(0.0).cwiseSqrt();
}

TargetResult compare(const Target& t, const Eigen::RowVectorXd& values, double parameter_sd) {
  TargetResult r;
  r.name = t.name;
  r.provenance = t.provenance;
  r.log_transform = t.log_transform;
  r.value = t.value;
  r.sigma = t.sigma;
  const double n = static_cast<double>(values.size());
  const double mean = values.mean();
  const double variance = (values.array() - mean).square().sum() / std::max(1.0, n - 1);
  r.simulated = untransformed(t, mean);
  r.seed_sd = std::sqrt(variance);
  r.parameter_sd = parameter_sd;
  r.sigma_total = std::hypot(total_sigma(t.sigma, variance, static_cast<int>(values.size()), 0.0), parameter_sd);
  r.residual = (mean - transformed(t, t.value)) / r.sigma_total;
  return r;
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
  const Eigen::MatrixXd samples = samples_at(evaluator, problem, unit);
  v.num_seeds = static_cast<int>(samples.cols());
  const Eigen::VectorXd by_parameters =
      v.num_seeds > 0 ? deviation_by_parameters(evaluator, problem, unit, v.has_parameter_errors)
                      : Eigen::VectorXd::Zero(samples.rows());
  double sum = 0.0;
  for (std::size_t k = 0; k < targets.size() && v.num_seeds > 0; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    v.targets.push_back(compare(problem.targets[k], samples.row(row), by_parameters[row]));
    sum += v.targets.back().residual * v.targets.back().residual;
  }
  if (!v.targets.empty()) v.rms = std::sqrt(sum / static_cast<double>(v.targets.size()));
  v.num_simulations = ledger.num_done;
  v.failures = ledger.failures;
  v.stopped = ledger.stop_seen;
  return v;
}

}  // namespace tilth
