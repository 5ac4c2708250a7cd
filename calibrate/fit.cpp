// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calibrate/fit_stages.hpp"
#include "calibrate/sobol_design.hpp"

namespace tilth {
namespace {

std::string joined(const std::vector<std::string>& sentences) {
  return fmt::format("{}", fmt::join(sentences, "; "));
}

std::vector<std::string> all_problems(const std::vector<Parameter>& parameters,
                                      const std::vector<Target>& targets,
                                      const FitOptions& options) {
  std::vector<std::string> found = problems(parameters);
  for (const auto& more : {problems(targets), problems(options)}) {
    found.insert(found.end(), more.begin(), more.end());
  }
  const std::size_t num_free = free_parameters(parameters).size();
  if (num_free > static_cast<std::size_t>(max_sobol_dimensions)) {
    found.push_back(fmt::format("{} free parameters: at most {}", num_free, max_sobol_dimensions));
  }
  return found;
}

// The last stages need these even if the search would use up the whole budget.
std::size_t reserve_for_the_end(const FitContext& context) {
  const auto seeds = static_cast<std::size_t>(context.options.num_search_seeds);
  const auto fresh = static_cast<std::size_t>(context.options.num_fresh_seeds);
  const std::size_t around = 1 + 2 * context.free.size();
  const std::size_t reserve = fresh + seeds * around + (context.holdout ? fresh + around : 0);
  return std::min(reserve, context.options.max_simulations / 2);
}

void prepare(FitContext& context) {
  const auto n = static_cast<Eigen::Index>(context.targets.size());
  const auto num_fitted = static_cast<Eigen::Index>(context.fitted.size());
  context.seed_variance = context.confirm_variance = context.bias = Eigen::VectorXd::Zero(n);
  context.bias_error = Eigen::VectorXd::Constant(n, not_known);
  context.seed_correlation = Eigen::MatrixXd::Identity(num_fitted, num_fitted);

  FitSummary& summary = context.summary;
  summary.num_free = context.free.size();
  summary.num_observations = context.fitted.size() + num_priors(context);
  summary.num_independent = num_independent_observations(context.targets) + num_priors(context);
  summary.degrees_of_freedom = degrees_of_freedom(context);
  summary.holdout_limit = context.options.holdout_limit;

  SimulationLedger& ledger = context.ledger;
  ledger.max_simulations = context.options.max_simulations;
  ledger.num_reserved = reserve_for_the_end(context);
  ledger.num_expected =
      expected_simulations(context.options, context.free.size(), context.confirm.has_value());
  ledger.should_stop = context.options.should_stop;
  ledger.progress = context.options.progress;
}

void run_stages(FitContext& context) {
  run_design(context);         // 1. spread points: what can the model reach
  run_noise(context);          // 2. repeat seeds: what is noise
  judge_gates(context);
  run_search_rounds(context);  // 3. emulator and global search, checked by real runs
  take_best_point(context);
  run_local_starts(context);   // 4. Levenberg-Marquardt from the best real points
  run_bias(context);           // 5. larger or slower runs: correct and refit
  find_conflicts(context);     // 6. what can be met alone, but not together
  context.ledger.num_reserved = 0;
  begin_stage(context.ledger, "uncertainty");
  update_uncertainty(context);  // 7. covariance at the optimum
  run_profiles(context);        // 8. how far each may move while the others follow
  report_parameters(context);
  run_fresh(context);  // 9. seeds and hold-outs the fit has never seen
}

void set_termination(FitContext& context) {
  FitSummary& summary = context.summary;
  const SimulationLedger& ledger = context.ledger;
  const auto set = [&](Termination termination, std::string message) {
    summary.termination = termination;
    summary.message = std::move(message);
  };
  if (ledger.too_many_failures) {
    set(Termination::too_many_failures,
        fmt::format("more than {:.0f} % of a batch failed, last reason: {}.",
                    100.0 * ledger.max_failed_share, ledger.failures.back().message));
  } else if (ledger.stop_seen) {
    set(Termination::stopped, "stopped on request; the best point so far is reported.");
  } else if (ledger.budget_spent) {
    set(Termination::budget_spent,
        fmt::format("the budget of {} simulations is spent.", ledger.max_simulations));
  } else if (!summary.is_usable()) {
    set(Termination::no_convergence, "no local search could be started: its runs failed.");
  } else if (!context.optimum->converged) {
    set(Termination::no_convergence,
        "the best local search ended before its stopping rule was met.");
  } else {
    set(Termination::converged, fmt::format("best value found {} times of {} starts.",
                                            summary.num_starts_at_best, summary.num_starts));
  }
}

// chi-square beyond its 1 in 10000 point (Wilson & Hilferty 1931: its cube root is nearly normal).
void warn_of_misfit(FitContext& context) {
  FitSummary& summary = context.summary;
  const double freedom = summary.degrees_of_freedom;
  if (context.options.rescale_sigma || freedom < 1.0) return;
  const double part = 2.0 / (9.0 * freedom);
  if (!(summary.chi_square > freedom * std::pow(1.0 - part + 3.72 * std::sqrt(part), 3.0))) return;
  summary.warnings.push_back(
      fmt::format("the model does not fit: reduced chi-square {:.3g}. Error bars and profiles count what noise does to "
                  "the best values, not what the misfit does: something is missing in model or data before they "
                  "can be believed",
                  summary.chi_square / freedom));
}

void report_counts(FitContext& context) {
  FitSummary& summary = context.summary;
  summary.num_simulations = context.ledger.num_done;
  summary.stages = context.ledger.stages;
  summary.failures = context.ledger.failures;
  if (context.optimum) {
    summary.chi_square = context.optimum->chi_square;
    if (!context.fitted.empty()) summary.r_squared = r_squared(context);
  }
  const KnownPoint& start = context.points.front();
  if (start.features) {
    summary.chi_square_start = fit_residuals(context, start.unit, *start.features, 1).squaredNorm();
  }
  const auto n = static_cast<Eigen::Index>(context.fitted.size());
  Eigen::VectorXd deviation(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = context.fitted[static_cast<std::size_t>(i)];
    deviation[i] = std::sqrt(context.seed_variance[static_cast<Eigen::Index>(k)]);
  }
  summary.seed_covariance =
      deviation.asDiagonal() * context.seed_correlation * deviation.asDiagonal();
}

}  // namespace

FitSummary fit(const std::vector<Parameter>& parameters, const std::vector<Target>& targets,
               const Simulator& search, const Simulator* confirm, const FitOptions& options,
               const Simulator* holdout) {
  FitSummary refused;
  refused.termination = Termination::bad_input;
  refused.message = joined(all_problems(parameters, targets, options));
  if (!refused.message.empty()) return refused;

  SimulationLedger ledger;
  const TargetScope scope = holdout != nullptr ? TargetScope::fitted : TargetScope::all;
  FitContext context{.parameters = parameters,
                     .targets = targets,
                     .options = options,
                     .free = free_parameters(parameters),
                     .fitted = fitted_targets(targets),
                     .ledger = ledger,
                     .search = Evaluator(search, targets, "search", ledger, scope),
                     .confirm = std::nullopt,
                     .holdout = std::nullopt};
  if (confirm != nullptr) context.confirm.emplace(*confirm, targets, "confirm", ledger, scope);
  if (holdout != nullptr)
    context.holdout.emplace(*holdout, targets, "hold-outs", ledger, TargetScope::holdouts);
  prepare(context);
  if (const Gate gate = determination_gate(context); !gate.passed && !options.force) {
    context.summary.gates = {gate};
    context.summary.termination = Termination::under_determined;
    context.summary.message = gate.words;
    return context.summary;
  }
  run_stages(context);
  set_termination(context);
  report_counts(context);
  warn_of_misfit(context);
  return context.summary;
}

}  // namespace tilth
