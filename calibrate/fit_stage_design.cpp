// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <numeric>

#include "calibrate/fit_stages.hpp"
#include "calibrate/seed_average.hpp"
#include "calibrate/sobol_design.hpp"

namespace tilth {
namespace {

// Fewer points say nothing about what the model can reach.
constexpr std::size_t min_points_for_reachability = 8;
constexpr double edge_in_sigmas = 2.0;

}  // namespace

void add_points(FitContext& context, const Eigen::MatrixXd& unit_points) {
  const auto means =
      average_over_seeds(context.search, context.parameters, context.targets, unit_points,
                         stage_seeds(context.options, SeedUse::search, 1));
  for (std::size_t i = 0; i < means.size(); ++i) {
    context.points.push_back({unit_points.col(static_cast<Eigen::Index>(i)), means[i]});
  }
}

std::vector<std::size_t> ranked_points(const FitContext& context) {
  std::vector<std::size_t> order;
  std::vector<double> chi_square(context.points.size(), 0.0);
  for (std::size_t i = 0; i < context.points.size(); ++i) {
    const KnownPoint& point = context.points[i];
    if (!point.features) continue;
    chi_square[i] = fit_residuals(context, point.unit, *point.features, 1).squaredNorm();
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return chi_square[a] < chi_square[b]; });
  return order;
}

void run_design(FitContext& context) {
  begin_stage(context.ledger, "design");
  const Eigen::VectorXd start = unit_start(context.parameters);
  const auto num_free = static_cast<int>(start.size());
  Eigen::MatrixXd design(num_free, 1 + context.options.num_design);
  design.col(0) = start;
  design.rightCols(context.options.num_design) =
      shifted_sobol_points(context.options.num_design, num_free, context.options.seed);
  add_points(context, design);

  take_best_point(context);
  if (context.optimum) record_cost(context, context.optimum->chi_square);
}

void take_best_point(FitContext& context) {
  const std::vector<std::size_t> order = ranked_points(context);
  if (order.empty()) return;
  const KnownPoint& best = context.points[order.front()];
  const double chi_square = fit_residuals(context, best.unit, *best.features, 1).squaredNorm();
  context.optimum = {best.unit, *best.features, 1, chi_square, false, false};
}

void set_reachability(const FitContext& context, std::size_t target, TargetResult& result) {
  const auto k = static_cast<Eigen::Index>(target);
  std::vector<double> seen;
  for (const KnownPoint& point : context.points) {
    if (point.features) seen.push_back((*point.features)[k] + context.bias[k]);
  }
  if (seen.size() < min_points_for_reachability) return;
  if (context.optimum) seen.push_back(context.optimum->mean[k] + context.bias[k]);
  const auto [least, most] = std::minmax_element(seen.begin(), seen.end());
  const double wanted = transformed(context.targets[target], context.targets[target].value);
  const double sigma =
      total_sigma(context.targets[target].sigma, model_variance(context, 1)[k], 1, 0.0);
  result.reach_gap = std::max(*least - wanted, wanted - *most) / sigma;
  result.reachability = result.reach_gap <= 0.0              ? Reachability::reachable
                        : result.reach_gap <= edge_in_sigmas ? Reachability::edge
                                                             : Reachability::unreachable;
}

}  // namespace tilth
