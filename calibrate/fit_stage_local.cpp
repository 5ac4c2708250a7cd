// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/fit_stages.hpp"
#include "calibrate/secants.hpp"
#include "calibrate/seed_average.hpp"

namespace tilth {
namespace {

constexpr double start_distance = 0.05;  // starts closer than this in the unit cube are one start
constexpr double same_chi_square = 0.1;  // "found the best value"

void warn_frozen(FitContext& context, const FrozenCounts& frozen) {
  for (const auto& [j, count] : frozen) {
    context.summary.warnings.push_back(
        fmt::format("{} was frozen for {} iteration(s) of a local search: the runs on both sides "
                    "of it failed",
                    context.parameters[context.free[j]].name, count));
  }
}

// The best real points, no two of them close together.
std::vector<Eigen::VectorXd> choose_starts(const FitContext& context) {
  std::vector<Eigen::VectorXd> starts;
  for (const std::size_t i : ranked_points(context)) {
    if (static_cast<int>(starts.size()) == context.options.num_starts) break;
    const Eigen::VectorXd& unit = context.points[i].unit;
    const bool is_new =
        std::none_of(starts.begin(), starts.end(), [&](const Eigen::VectorXd& other) {
          return (other - unit).lpNorm<Eigen::Infinity>() < start_distance;
        });
    if (is_new) starts.push_back(unit);
  }
  return starts;
}

// A model that misses its data by many sigma has a chi-square landscape that is as much steeper: what is
// small beside it is small beside what it means, so the tolerance grows with the reduced chi-square.
double scaled_tolerance(const FitContext& context) {
  const int freedom = std::max(1, degrees_of_freedom(context));
  const double reduced = context.optimum ? context.optimum->chi_square / freedom : 1.0;
  return context.options.chi_square_tolerance * std::max(1.0, reduced);
}

// The noise of single runs lets no secant judge a step so much shorter than itself.
double least_step(const FitContext& context) {
  const FitOptions& o = context.options;
  if (o.derivatives != DerivativeRule::secants) return 0.0;
  return o.secant_tolerance * secant_steps(context.parameters, o.log_step, o.linear_step).minCoeff();
}

LeastSquaresOptions local_options(FitContext& context) {
  LeastSquaresOptions options;
  options.max_iterations = context.options.max_iterations;
  options.absolute_tolerance = scaled_tolerance(context);
  options.function_tolerance = context.options.function_tolerance;
  options.parameter_tolerance = context.options.parameter_tolerance;
  options.least_step = least_step(context);
  options.gradient_tolerance = context.options.gradient_tolerance;
  options.should_stop = [&context] { return is_blocked(context.ledger); };
  return options;
}

}  // namespace

LeastSquaresProblem local_problem(FitContext& context, FrozenCounts& frozen) {
  const auto d = static_cast<Eigen::Index>(context.free.size());
  const auto seeds =
      stage_seeds(context.options, SeedUse::search, context.options.num_search_seeds);
  LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Zero(d);
  problem.upper = Eigen::VectorXd::Ones(d);
  problem.num_residuals = static_cast<int>(context.fitted.size() + num_priors(context));
  problem.evaluate = [&context, &frozen, seeds](const Eigen::VectorXd& unit,
                                                Eigen::VectorXd& residuals,
                                                Eigen::MatrixXd* jacobian) {
    const auto num_seeds = static_cast<int>(seeds.size());
    if (jacobian == nullptr) {
      const auto mean =
          average_over_seeds(context.search, context.parameters, context.targets, unit, seeds)
              .front();
      if (!mean) return false;
      residuals = fit_residuals(context, unit, *mean, num_seeds);
      return true;
    }
    const auto secants = search_derivatives_at(context, unit);
    if (!secants) return false;
    for (const std::size_t j : secants->frozen) ++frozen[j];
    residuals = fit_residuals(context, unit, secants->base, num_seeds);
    *jacobian = residual_jacobian(context, secants->jacobian, num_seeds);
    return true;
  };
  return problem;
}

void refit_from(FitContext& context, const Eigen::VectorXd& unit_start) {
  FrozenCounts frozen;
  const LeastSquaresProblem problem = local_problem(context, frozen);
  const LeastSquaresResult found = minimise_with_ceres(problem, unit_start, local_options(context));
  warn_frozen(context, frozen);
  context.summary.starts.push_back(
      {context.ledger.stage, physical_point(context.parameters, unit_start),
       physical_point(context.parameters, found.x), found.sum_of_squares_start,
       found.sum_of_squares, found.num_iterations, found.usable, found.converged, found.message});
  if (!found.usable) return;
  record_cost(context, found.sum_of_squares);
  const int num_seeds = context.options.num_search_seeds;
  const bool first = !context.optimum || !context.optimum->from_local_search;
  if (!first && found.sum_of_squares > context.optimum->chi_square) return;
  const auto seeds = stage_seeds(context.options, SeedUse::search, num_seeds);
  const auto mean =
      average_over_seeds(context.search, context.parameters, context.targets, found.x, seeds)
          .front();  // remembered: no new run
  context.optimum = {found.x, *mean, num_seeds, found.sum_of_squares, true, found.converged};
}

void run_local_starts(FitContext& context) {
  begin_stage(context.ledger, "local search");
  for (const Eigen::VectorXd& start : choose_starts(context)) {
    if (is_blocked(context.ledger)) break;
    refit_from(context, start);
  }
  context.summary.num_starts = static_cast<int>(context.summary.starts.size());
  for (const StartResult& start : context.summary.starts) {
    if (start.usable && start.chi_square <= context.optimum->chi_square + same_chi_square) {
      ++context.summary.num_starts_at_best;
    }
  }
}

}  // namespace tilth
