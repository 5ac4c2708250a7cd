// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "calibrate/emulator.hpp"
#include "calibrate/fit_stages.hpp"
#include "calibrate/optimise_nlopt.hpp"
#include "calibrate/sobol_design.hpp"

namespace tilth {
namespace {

constexpr double same_point = 0.02;    // closer points of the unit cube are not simulated again
constexpr double spread_radius = 0.1;  // half-width of the cloud around the emulator's optimum
constexpr int evaluations_per_dimension = 400;

// chi-square of the emulated model. With `doubtful`, each residual is divided by sigma_total and
// the emulator's own uncertainty together, which makes unknown regions worth a visit.
double emulated_chi_square(const FitContext& context, const std::vector<Emulator>& emulators,
                           const Eigen::VectorXd& unit, bool doubtful) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(context.targets.size()));
  Eigen::VectorXd variance(static_cast<Eigen::Index>(emulators.size()));
  for (std::size_t i = 0; i < emulators.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(context.fitted[i]);
    if (doubtful) {
      const EmulatorPrediction prediction = emulators[i].predict(unit);
      mean[k] = prediction.mean;
      variance[static_cast<Eigen::Index>(i)] = prediction.variance;
    } else {
      mean[k] = emulators[i].predict_mean(unit);
    }
  }
  Eigen::VectorXd residuals = fit_residuals(context, unit, mean, 1);
  if (doubtful) {
    const Eigen::VectorXd sigmas = fitted_sigmas(context, 1);
    residuals.head(sigmas.size()).array() /=
        (1.0 + variance.array() / sigmas.array().square()).sqrt();
  }
  return residuals.squaredNorm();
}

Eigen::VectorXd emulated_optimum(const FitContext& context, const std::vector<Emulator>& emulators,
                                 bool doubtful, std::uint64_t seed) {
  const Eigen::Index d = context.optimum->unit.size();
  const auto objective = [&](const Eigen::VectorXd& unit) {
    return emulated_chi_square(context, emulators, unit, doubtful);
  };
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(d);
  const Eigen::VectorXd upper = Eigen::VectorXd::Ones(d);
  const int budget = evaluations_per_dimension * static_cast<int>(d);
  const NloptResult global = minimise_with_nlopt(objective, lower, upper, context.optimum->unit,
                                                 {NloptAlgorithm::crs2, budget, 1e-3, seed});
  return minimise_with_nlopt(objective, lower, upper, global.x,
                             {NloptAlgorithm::sbplx, budget, 1e-4, seed})
      .x;
}

// Worth a run: not simulated yet, and its nearest known point did not fail.
bool is_worth_a_run(const FitContext& context, const Eigen::MatrixXd& chosen,
                    const Eigen::VectorXd& unit) {
  for (Eigen::Index i = 0; i < chosen.cols(); ++i) {
    if ((chosen.col(i) - unit).lpNorm<Eigen::Infinity>() < same_point) return false;
  }
  double nearest = std::numeric_limits<double>::infinity();
  bool nearest_completed = true;
  for (const KnownPoint& point : context.points) {
    const double distance = (point.unit - unit).lpNorm<Eigen::Infinity>();
    if (distance >= nearest) continue;
    nearest = distance;
    nearest_completed = point.features.has_value();
  }
  return nearest >= same_point && nearest_completed;
}

// The emulator's optimum, the optima of its doubtful criterion, and a cloud around the best known
// point in place of candidates not worth a run.
Eigen::MatrixXd candidates(const FitContext& context, const std::vector<Emulator>& emulators,
                           int round) {
  const int size = context.options.round_size;
  const auto d = static_cast<int>(context.free.size());
  const std::uint64_t seed = context.options.seed + static_cast<std::uint64_t>(100 * (round + 1));
  const Eigen::MatrixXd cloud = shifted_sobol_points(size, d, seed);
  Eigen::MatrixXd chosen(d, 0);
  Eigen::VectorXd centre = context.optimum->unit;
  for (int i = 0; i < size; ++i) {
    const bool doubtful = i % 2 == 1;
    Eigen::VectorXd unit = centre;
    if (i == 0 || doubtful) {
      unit = emulated_optimum(context, emulators, doubtful, seed + static_cast<std::uint64_t>(i));
    }
    if (is_worth_a_run(context, chosen, unit)) {
      if (i == 0) centre = unit;
    } else {
      unit = centre.array() + spread_radius * (2.0 * cloud.col(i).array() - 1.0);
      unit = unit.cwiseMax(0.0).cwiseMin(1.0);
    }
    chosen.conservativeResize(Eigen::NoChange, i + 1);
    chosen.col(i) = unit;
  }
  return chosen;
}

}  // namespace

std::vector<Emulator> make_emulators(const FitContext& context) {
  std::vector<const KnownPoint*> completed;
  for (const KnownPoint& point : context.points) {
    if (point.features) completed.push_back(&point);
  }
  const auto num_free = static_cast<Eigen::Index>(context.free.size());
  const auto n = static_cast<Eigen::Index>(completed.size());
  std::vector<Emulator> emulators;
  if (n < min_emulator_points(EmulatorTrend::linear, num_free)) return emulators;

  Eigen::MatrixXd points(num_free, n);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(context.targets.size()), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    points.col(i) = completed[static_cast<std::size_t>(i)]->unit;
    values.col(i) = *completed[static_cast<std::size_t>(i)]->features;
  }
  for (const std::size_t k : context.fitted) {
    emulators.emplace_back(points, values.row(static_cast<Eigen::Index>(k)).transpose(),
                           EmulatorOptions{});
  }
  return emulators;
}

const std::vector<Emulator>& final_emulators(FitContext& context) {
  if (!context.emulators) context.emulators = make_emulators(context);
  return *context.emulators;
}

void run_search_rounds(FitContext& context) {
  if (!context.optimum || context.options.num_rounds == 0) return;
  begin_stage(context.ledger, "search");
  for (int round = 0; round < context.options.num_rounds; ++round) {
    if (is_blocked(context.ledger)) return;
    const std::vector<Emulator> emulators = make_emulators(context);
    if (emulators.empty()) {
      context.summary.warnings.push_back(fmt::format(
          "no emulator: {} parameters need {} completed design points", context.free.size(),
          min_emulator_points(EmulatorTrend::linear,
                              static_cast<Eigen::Index>(context.free.size()))));
      return;
    }
    add_points(context, candidates(context, emulators, round));
    take_best_point(context);
    record_cost(context, context.optimum->chi_square);
  }
}

}  // namespace tilth
