// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/extrapolated_derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/seed_average.hpp"

namespace tilth {
namespace {

constexpr int num_halvings = 7;
constexpr double first_share = 0.05;
constexpr double least_step = 1e-6;  // of the range
constexpr double most_step = 0.25;

// How one parameter is moved: forward and backward members in pairs, or one side only.
struct Moves {
  bool central = true;
  double sign = 1.0;                  // of a one-sided step
  std::vector<Eigen::Index> columns;  // of the batch, in order of the halvings
};

double first_step(const Parameter& p, double unit) {
  const double span = coordinate_span(p);
  const double value = physical_from_unit(p, unit);
  const double step = p.secant_step ? *p.secant_step / span
                      : p.log_scale ? first_share / span
                                    : first_share * std::abs(value) / span;
  return std::clamp(step, least_step, most_step);
}

// What a unit coordinate is worth after the rounding of the physical value.
double unit_of(const Parameter& p, double unit) {
  return coordinate_from_physical(p, physical_from_unit(p, unit)) / coordinate_span(p);
}

class Batch {
 public:
  explicit Batch(const Eigen::VectorXd& unit) : points_(unit) {}

  Moves add_moves(const Parameter& p, Eigen::Index j) {
    const double u = points_(j, 0);
    double step = first_step(p, u);
    Moves moves;
    moves.central = std::min(u, 1.0 - u) >= step;
    moves.sign = u > 0.5 ? -1.0 : 1.0;
    for (int i = 0; i <= num_halvings; ++i, step *= 0.5) {
      moves.columns.push_back(add(j, u + moves.sign * step));
      if (moves.central) moves.columns.push_back(add(j, u - moves.sign * step));
    }
    return moves;
  }
  const Eigen::MatrixXd& points() const { return points_; }

 private:
  Eigen::Index add(Eigen::Index j, double unit) {
    points_.conservativeResize(Eigen::NoChange, points_.cols() + 1);
    points_.rightCols(1) = points_.col(0);
    points_(j, points_.cols() - 1) = unit;
    return points_.cols() - 1;
  }

  Eigen::MatrixXd points_;
};

using Means = std::vector<std::optional<Eigen::VectorXd>>;

// Quotients behind the last failure, largest step first.
std::vector<Eigen::VectorXd> quotients(const Moves& moves, const Means& means,
                                       const Eigen::MatrixXd& points, const Parameter& p,
                                       Eigen::Index j) {
  std::vector<Eigen::VectorXd> found;
  const std::size_t per_step = moves.central ? 2 : 1;
  for (std::size_t i = 0; i + per_step <= moves.columns.size(); i += per_step) {
    const Eigen::Index one = moves.columns[i];
    const Eigen::Index other = moves.central ? moves.columns[i + 1] : 0;
    const auto& high = means[static_cast<std::size_t>(one)];
    const auto& low = means[static_cast<std::size_t>(other)];
    const double distance = unit_of(p, points(j, one)) - unit_of(p, points(j, other));
    if (!high || !low || distance == 0.0) {
      found.clear();
      continue;
    }
    found.push_back((*high - *low) / distance);
  }
  return found;
}

}  // namespace

Eigen::VectorXd extrapolated_quotient(const std::vector<Eigen::VectorXd>& quotients, double ratio) {
  Eigen::VectorXd best = quotients.front();
  Eigen::VectorXd best_error =
      Eigen::VectorXd::Constant(best.size(), std::numeric_limits<double>::infinity());
  std::vector<Eigen::VectorXd> previous;
  for (const Eigen::VectorXd& quotient : quotients) {
    std::vector<Eigen::VectorXd> row = {quotient};
    double factor = ratio;
    for (std::size_t k = 0; k < previous.size(); ++k, factor *= ratio) {
      row.push_back((factor * row[k] - previous[k]) / (factor - 1.0));
      const Eigen::VectorXd error =
          (row[k + 1] - row[k]).cwiseAbs().cwiseMax((row[k + 1] - previous[k]).cwiseAbs());
      best = (error.array() < best_error.array()).select(row[k + 1], best);
      best_error = best_error.cwiseMin(error);
    }
    previous = std::move(row);
  }
  return best;
}

std::optional<Secants> extrapolated_derivatives(Evaluator& evaluator,
                                                std::span<const Parameter> parameters,
                                                std::span<const Target> targets,
                                                const Eigen::VectorXd& unit,
                                                std::span<const std::uint64_t> seeds) {
  const std::vector<std::size_t> free = free_parameters(parameters);
  Batch batch(unit);
  std::vector<Moves> moves;
  for (std::size_t j = 0; j < free.size(); ++j)
    moves.push_back(batch.add_moves(parameters[free[j]], static_cast<Eigen::Index>(j)));
  const Means means = average_over_seeds(evaluator, parameters, targets, batch.points(), seeds);
  if (!means.front()) return std::nullopt;

  Secants result;
  result.base = *means.front();
  result.jacobian = Eigen::MatrixXd::Zero(result.base.size(), unit.size());
  for (std::size_t j = 0; j < free.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const auto found = quotients(moves[j], means, batch.points(), parameters[free[j]], column);
    if (found.empty()) {
      result.frozen.push_back(j);
      continue;
    }
    result.jacobian.col(column) = extrapolated_quotient(found, moves[j].central ? 4.0 : 2.0);
    if (!moves[j].central) result.one_sided.push_back(j);
  }
  return result;
}

}  // namespace tilth
