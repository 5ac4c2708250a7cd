// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/profile.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

namespace tilth {
namespace {

constexpr double error_steps[] = {0.5, 1.0, 1.5, 2.0, 3.0};
constexpr double large_error = 0.25;  // of the cube: the even points do
constexpr double same_point = 1e-9;
constexpr int max_refinements = 16;
constexpr double close_enough = 0.01;  // of the level

Eigen::VectorXd without(const Eigen::VectorXd& all, Eigen::Index held) {
  Eigen::VectorXd others(all.size() - 1);
  others << all.head(held), all.tail(all.size() - held - 1);
  return others;
}

Eigen::VectorXd with(const Eigen::VectorXd& others, Eigen::Index held, double value) {
  Eigen::VectorXd all(others.size() + 1);
  all << others.head(held), value, others.tail(others.size() - held);
  return all;
}

class Profiler {
 public:
  Profiler(const LeastSquaresProblem& problem, const Eigen::VectorXd& optimum, int held,
           const Eigen::MatrixXd& candidates, const ProfileOptions& options)
      : problem_(problem),
        optimum_(optimum),
        held_(held),
        candidates_(candidates),
        options_(options) {}

  // The least |r|^2 at this value, from a neighbour's end or a better candidate.
  std::optional<ProfilePoint> at(double value, const Eigen::VectorXd& neighbour,
                                 double reach) const {
    std::optional<ProfilePoint> best = refit(value, neighbour);
    const std::optional<Eigen::VectorXd> other = best_candidate(value, reach, best);
    if (other) {
      const std::optional<ProfilePoint> second = refit(value, *other);
      if (second && (!best || second->chi_square < best->chi_square)) best = second;
    }
    if (best) judge_bounds(*best);
    return best;
  }

 private:
  std::optional<ProfilePoint> refit(double value, const Eigen::VectorXd& start) const {
    if (optimum_.size() == 1) return alone(value);
    const LeastSquaresProblem others = restricted(value);
    LeastSquaresOptions options;
    options.max_iterations = options_.max_iterations;
    options.function_tolerance = options_.function_tolerance;
    options.absolute_tolerance = 1e-5 * options_.level;
    const LeastSquaresResult found = minimise_with_ceres(others, without(start, held_), options);
    if (!found.usable) return std::nullopt;
    return ProfilePoint{with(found.x, held_, value), found.sum_of_squares, -1, 0.0};
  }

  std::optional<ProfilePoint> alone(double value) const {
    Eigen::VectorXd residuals(problem_.num_residuals);
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(1, value);
    if (!problem_.evaluate(unit, residuals, nullptr)) return std::nullopt;
    return ProfilePoint{unit, residuals.squaredNorm(), -1, 0.0};
  }

  LeastSquaresProblem restricted(double value) const {
    LeastSquaresProblem others;
    others.lower = without(problem_.lower, held_);
    others.upper = without(problem_.upper, held_);
    others.num_residuals = problem_.num_residuals;
    others.evaluate = [this, value](const Eigen::VectorXd& x, Eigen::VectorXd& residuals,
                                    Eigen::MatrixXd* jacobian) {
      Eigen::MatrixXd whole(problem_.num_residuals, optimum_.size());
      const Eigen::VectorXd unit = with(x, held_, value);
      if (!problem_.evaluate(unit, residuals, jacobian != nullptr ? &whole : nullptr)) return false;
      if (jacobian != nullptr) {
        jacobian->leftCols(held_) = whole.leftCols(held_);
        jacobian->rightCols(x.size() - held_) = whole.rightCols(x.size() - held_);
      }
      return true;
    };
    return others;
  }

  // The best candidate within reach of the value, moved onto it, if it beats what is known there.
  std::optional<Eigen::VectorXd> best_candidate(double value, double reach,
                                                const std::optional<ProfilePoint>& known) const {
    std::optional<Eigen::VectorXd> best;
    double least = known ? known->chi_square : not_known;
    Eigen::VectorXd residuals(problem_.num_residuals);
    for (Eigen::Index i = 0; i < candidates_.cols(); ++i) {
      if (std::abs(candidates_(held_, i) - value) > reach) continue;
      Eigen::VectorXd unit = candidates_.col(i);
      unit[held_] = value;
      if (!problem_.evaluate(unit, residuals, nullptr)) continue;
      if (residuals.squaredNorm() >= least) continue;
      least = residuals.squaredNorm();
      best = unit;
    }
    return best;
  }

  // |M J_held|^2, M = projection off the columns of the others that are free.
  double curvature(const Eigen::MatrixXd& jacobian, const std::vector<bool>& free) const {
    Eigen::MatrixXd columns(jacobian.rows(), 0);
    for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
      if (i == held_ || !free[static_cast<std::size_t>(i)]) continue;
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
      columns.rightCols(1) = jacobian.col(i);
    }
    const Eigen::VectorXd held = jacobian.col(held_);
    if (columns.cols() == 0) return held.squaredNorm();
    return (held - columns * columns.completeOrthogonalDecomposition().solve(held)).squaredNorm();
  }

  // Which bound holds the fit back here, and what would remain without it.
  void judge_bounds(ProfilePoint& point) const {
    std::vector<bool> free(static_cast<std::size_t>(optimum_.size()), true);
    bool any = false;
    for (Eigen::Index i = 0; i < optimum_.size(); ++i) {
      const bool at_bound =
          point.unit[i] <= problem_.lower[i] || point.unit[i] >= problem_.upper[i];
      if (i == held_ || !at_bound) continue;
      free[static_cast<std::size_t>(i)] = false;
      any = true;
    }
    if (!any) return;
    Eigen::VectorXd residuals(problem_.num_residuals);
    Eigen::MatrixXd jacobian(problem_.num_residuals, optimum_.size());
    if (!problem_.evaluate(point.unit, residuals, &jacobian)) return;
    const double distance = point.unit[held_] - optimum_[held_];
    const Eigen::VectorXd gradient = jacobian.transpose() * residuals;
    for (Eigen::Index i = 0; i < optimum_.size(); ++i) {
      if (i == held_ || free[static_cast<std::size_t>(i)]) continue;
      const bool pushes =
          point.unit[i] <= problem_.lower[i] ? gradient[i] > 0.0 : gradient[i] < 0.0;
      if (!pushes) continue;
      free[static_cast<std::size_t>(i)] = true;
      const double rest = curvature(jacobian, free) * distance * distance;
      free[static_cast<std::size_t>(i)] = false;
      if (point.at_bound >= 0 && rest >= point.if_lifted) continue;
      point.at_bound = static_cast<int>(i);
      point.if_lifted = rest;
    }
  }

  const LeastSquaresProblem& problem_;
  const Eigen::VectorXd& optimum_;
  Eigen::Index held_;
  const Eigen::MatrixXd& candidates_;
  const ProfileOptions& options_;
};

// Values on one side of the optimum, nearest first.
std::vector<double> values_on_side(double centre, double sign, double standard_error,
                                   int num_grid) {
  std::vector<double> values;
  for (int i = 0; i <= num_grid; ++i) values.push_back(static_cast<double>(i) / num_grid);
  if (standard_error > 0.0 && standard_error < large_error) {
    for (const double step : error_steps) values.push_back(centre + sign * step * standard_error);
  }
  std::erase_if(values,
                [&](double v) { return v < 0.0 || v > 1.0 || sign * (v - centre) < same_point; });
  std::ranges::sort(values, {}, [&](double v) { return sign * v; });
  const auto twins =
      std::ranges::unique(values, [](double a, double b) { return std::abs(a - b) < same_point; });
  values.erase(twins.begin(), twins.end());
  return values;
}

// Where the difference crosses the level between two points, interpolated in its square root.
double crossing(const ProfilePoint& a, const ProfilePoint& b, Eigen::Index held, double least,
                double level) {
  const double root_a = std::sqrt(std::max(0.0, a.chi_square - least));
  const double root_b = std::sqrt(std::max(0.0, b.chi_square - least));
  const double share = (std::sqrt(level) - root_a) / (root_b - root_a);
  return a.unit[held] + std::clamp(share, 0.0, 1.0) * (b.unit[held] - a.unit[held]);
}

// Adds points where the profile first crosses the level on one side: by interpolation and, since a
// bound makes a kink, every second time in the middle.
void close_in(const Profiler& profiler, Profile& side, Eigen::Index held, double least,
              double level) {
  for (int i = 0; i < max_refinements; ++i) {
    const auto outside = std::ranges::find_if(
        side, [&](const ProfilePoint& p) { return p.chi_square - least > level; });
    if (outside == side.begin() || outside == side.end()) return;
    const ProfilePoint& inside = *(outside - 1);
    if (std::abs(outside->unit[held] - inside.unit[held]) < same_point) return;
    const double value = i % 2 == 0 ? crossing(inside, *outside, held, least, level)
                                    : 0.5 * (inside.unit[held] + outside->unit[held]);
    const auto point = profiler.at(value, inside.unit, 0.0);
    if (!point) return;
    const bool is_close = std::abs(point->chi_square - least - level) < close_enough * level;
    side.insert(outside, *point);
    if (is_close) return;
  }
}

}  // namespace

Profile draw_profile(const LeastSquaresProblem& problem, const Eigen::VectorXd& optimum, int held,
                     double standard_error, const Eigen::MatrixXd& candidates,
                     const ProfileOptions& options) {
  const Profiler profiler(problem, optimum, held, candidates, options);
  const auto centre = profiler.at(optimum[held], optimum, 0.0);
  if (!centre) return {};
  Profile profile = {*centre};
  for (const double sign : {-1.0, 1.0}) {
    Profile side = {*centre};
    const double reach = 0.5 / options.num_grid;
    for (const double value :
         values_on_side(optimum[held], sign, standard_error, options.num_grid)) {
      if (const auto point = profiler.at(value, side.back().unit, reach)) side.push_back(*point);
    }
    close_in(profiler, side, held, centre->chi_square, options.level);
    profile.insert(profile.end(), side.begin() + 1, side.end());
  }
  std::ranges::sort(profile, {}, [&](const ProfilePoint& p) { return p.unit[held]; });
  return profile;
}

ProfileReading read_profile(const Profile& profile, int held, double least, double level) {
  ProfileReading reading;
  if (profile.size() < 2) return reading;
  const auto difference = [&](std::size_t i) { return profile[i].chi_square - least; };
  std::size_t centre = 0;
  for (std::size_t i = 1; i < profile.size(); ++i)
    centre = difference(i) < difference(centre) ? i : centre;
  const auto limits = [&](const ProfilePoint& point) {
    if (point.at_bound >= 0 && point.if_lifted < 0.25 * level) reading.limited_by = point.at_bound;
  };
  std::size_t high = centre;
  while (high < profile.size() && difference(high) <= level) ++high;
  if (high < profile.size() && high > centre) {
    reading.high = crossing(profile[high - 1], profile[high], held, least, level);
    limits(profile[high]);
  }
  std::size_t low = centre;  // one past the first point outside
  while (low > 0 && difference(low - 1) <= level) --low;
  if (low > 0) {
    reading.low = crossing(profile[low], profile[low - 1], held, least, level);
    limits(profile[low - 1]);
  }
  bool comes_back = false;
  for (std::size_t i = 0; i < profile.size(); ++i)
    comes_back = comes_back || ((i < low || i >= high) && difference(i) <= level);
  const int num_crossed = (std::isnan(reading.low) ? 0 : 1) + (std::isnan(reading.high) ? 0 : 1);
  reading.verdict = comes_back                ? ParameterVerdict::multimodal
                    : reading.limited_by >= 0 ? ParameterVerdict::bound_limited
                    : num_crossed == 2        ? ParameterVerdict::identified
                    : num_crossed == 1        ? ParameterVerdict::one_sided
                                              : ParameterVerdict::flat;
  if (reading.verdict != ParameterVerdict::bound_limited) reading.limited_by = -1;
  return reading;
}

}  // namespace tilth
