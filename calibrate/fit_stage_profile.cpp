// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/equivalence_family.hpp"
#include "calibrate/fit_stages.hpp"
#include "calibrate/sobol_design.hpp"
#include "calibrate/student_t.hpp"

namespace tilth {
namespace {

constexpr int num_probes = 256;         // of the emulated model, to look for separate regions
constexpr double emulator_step = 1e-4;  // of the cube; emulators are smooth
constexpr int family_size = 12;
constexpr double family_distance = 1e-3;

// Residuals of the emulated model, each divided by sigma_total and the emulator's own uncertainty
// together. The emulators stand for one packing; shifting them onto the measured mean at the
// optimum puts the packings and the bias in.
struct EmulatedModel {
  const FitContext& context;
  const std::vector<Emulator>& emulators;
  Eigen::VectorXd shift;   // T, all targets
  Eigen::VectorXd sigmas;  // (num_fitted)

  EmulatedModel(const FitContext& c, const std::vector<Emulator>& e)
      : context(c), emulators(e), sigmas(fitted_sigmas(c, c.optimum->num_seeds)) {
    shift = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(c.targets.size()));
    for (std::size_t i = 0; i < e.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(c.fitted[i]);
      shift[k] = c.optimum->mean[k] - e[i].predict_mean(c.optimum->unit);
    }
  }

  Eigen::VectorXd residuals(const Eigen::VectorXd& unit) const {
    Eigen::VectorXd mean = shift;
    Eigen::VectorXd widening(sigmas.size());
    for (std::size_t i = 0; i < emulators.size(); ++i) {
      const EmulatorPrediction predicted = emulators[i].predict(unit);
      const auto row = static_cast<Eigen::Index>(i);
      mean[static_cast<Eigen::Index>(context.fitted[i])] += predicted.mean;
      widening[row] = std::sqrt(1.0 + predicted.variance / (sigmas[row] * sigmas[row]));
    }
    Eigen::VectorXd result = fit_residuals(context, unit, mean, context.optimum->num_seeds);
    result.head(sigmas.size()).array() /= widening.array();
    return result;
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& unit, Eigen::Index num_residuals) const {
    Eigen::MatrixXd result(num_residuals, unit.size());
    for (Eigen::Index j = 0; j < unit.size(); ++j) {
      Eigen::VectorXd high = unit;
      Eigen::VectorXd low = unit;
      high[j] = std::min(1.0, unit[j] + emulator_step);
      low[j] = std::max(0.0, unit[j] - emulator_step);
      result.col(j) = (residuals(high) - residuals(low)) / (high[j] - low[j]);
    }
    return result;
  }
};

LeastSquaresProblem unit_cube_problem(const FitContext& context) {
  const auto d = static_cast<Eigen::Index>(context.free.size());
  LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Zero(d);
  problem.upper = Eigen::VectorXd::Ones(d);
  problem.num_residuals = static_cast<int>(context.fitted.size() + num_priors(context));
  return problem;
}

LeastSquaresProblem emulated_problem(const FitContext& context, const EmulatedModel& model) {
  LeastSquaresProblem problem = unit_cube_problem(context);
  problem.evaluate = [&context, &model](const Eigen::VectorXd& unit, Eigen::VectorXd& residuals,
                                        Eigen::MatrixXd* jacobian) {
    const double scale = sigma_scale(context);
    residuals = model.residuals(unit) / scale;
    if (jacobian != nullptr) *jacobian = model.jacobian(unit, residuals.size()) / scale;
    return true;
  };
  return problem;
}

// The search simulator itself, in units of the rescaled sigma.
LeastSquaresProblem rescaled_problem(FitContext& context, FrozenCounts& frozen) {
  LeastSquaresProblem problem = local_problem(context, frozen);
  problem.evaluate = [&context, whole = problem.evaluate](const Eigen::VectorXd& unit,
                                                          Eigen::VectorXd& residuals,
                                                          Eigen::MatrixXd* jacobian) {
    if (!whole(unit, residuals, jacobian)) return false;
    residuals /= sigma_scale(context);
    if (jacobian != nullptr) *jacobian /= sigma_scale(context);
    return true;
  };
  return problem;
}

double unit_error(const FitContext& context, std::size_t j) {
  const auto index = static_cast<Eigen::Index>(j);
  if (!context.uncertainty || !context.uncertainty->is_fixed(index)) return not_known;
  return std::sqrt(context.uncertainty->covariance(index, index));
}

void draw_all(FitContext& context, const LeastSquaresProblem& problem,
              const Eigen::MatrixXd& candidates) {
  ProfileOptions options;
  options.level = context.summary.profile_level;
  if (context.options.derivatives == DerivativeRule::extrapolated) {
    options.max_iterations = context.options.max_iterations;
    options.function_tolerance = 1e-9;
  }
  context.least_profile = not_known;
  for (std::size_t j = 0; j < context.free.size(); ++j) {
    context.profiles.push_back(draw_profile(problem, context.optimum->unit, static_cast<int>(j),
                                            unit_error(context, j), candidates, options));
    for (const ProfilePoint& point : context.profiles.back()) {
      if (!(point.chi_square >= context.least_profile)) context.least_profile = point.chi_square;
    }
  }
}

void report_profiles(FitContext& context) {
  for (std::size_t j = 0; j < context.profiles.size(); ++j) {
    ParameterProfile out;
    out.parameter = context.parameters[context.free[j]].name;
    for (const ProfilePoint& point : context.profiles[j]) {
      const Eigen::VectorXd values = physical_point(context.parameters, point.unit);
      out.values.push_back(values[static_cast<Eigen::Index>(context.free[j])]);
      out.chi_square_difference.push_back(point.chi_square - context.least_profile);
      out.points.push_back(values);
      out.at_bound.push_back(
          point.at_bound < 0
              ? ""
              : context.parameters[context.free[static_cast<std::size_t>(point.at_bound)]].name);
    }
    context.summary.profiles.push_back(out);
  }
}

// The optimum, and points of the profiles below the level that are as far apart as can be.
void report_family(FitContext& context) {
  const double level = context.summary.profile_level;
  Eigen::MatrixXd points = context.optimum->unit;
  std::vector<double> differences = {0.0};
  for (const Profile& profile : context.profiles) {
    for (const ProfilePoint& point : profile) {
      if (point.chi_square - context.least_profile > level) continue;
      points.conservativeResize(Eigen::NoChange, points.cols() + 1);
      points.rightCols(1) = point.unit;
      differences.push_back(point.chi_square - context.least_profile);
    }
  }
  for (const Eigen::Index i : farthest_columns(points, family_size, family_distance)) {
    context.summary.equivalence_family.push_back({physical_point(context.parameters, points.col(i)),
                                                  differences[static_cast<std::size_t>(i)]});
  }
}

void profile_on_emulators(FitContext& context) {
  const std::vector<Emulator>& emulators = final_emulators(context);
  if (emulators.empty()) return;
  const EmulatedModel model(context, emulators);
  const auto num_free = static_cast<int>(context.free.size());
  draw_all(context, emulated_problem(context, model),
           shifted_sobol_points(num_probes, num_free, context.options.seed));
  context.summary.profile_source =
      "emulators of the search runs, shifted onto the measured mean at the optimum and "
      "widened by their own uncertainty";
}

void profile_on_simulator(FitContext& context) {
  begin_stage(context.ledger, "profiles");
  FrozenCounts frozen;
  Eigen::MatrixXd candidates(static_cast<Eigen::Index>(context.free.size()), 0);
  for (const KnownPoint& point : context.points) {
    if (!point.features) continue;
    candidates.conservativeResize(Eigen::NoChange, candidates.cols() + 1);
    candidates.rightCols(1) = point.unit;
  }
  draw_all(context, rescaled_problem(context, frozen), candidates);
  context.summary.profile_source = "the search simulator";
}

}  // namespace

void run_profiles(FitContext& context) {
  if (context.options.profiles == ProfileSource::none || !context.optimum) return;
  if (!context.optimum->from_local_search || std::isnan(sigma_scale(context))) return;
  context.summary.profile_level = chi_square_95;
  if (context.options.rescale_sigma) {
    context.summary.profile_level =
        std::pow(student_t_half_width(0.95, degrees_of_freedom(context)), 2);
  }
  if (context.options.profiles == ProfileSource::simulator) {
    profile_on_simulator(context);
  } else {
    profile_on_emulators(context);
  }
  if (context.options.profiles == ProfileSource::simulator && is_blocked(context.ledger)) {
    // Half a profile looks like an open end.
    context.profiles.clear();
    context.summary.warnings.emplace_back("no profiles: stopped, or the budget is spent");
  }
  if (context.profiles.empty()) return;
  report_profiles(context);
  report_family(context);
}

void set_profile_verdict(const FitContext& context, std::size_t j, FittedParameter& fitted) {
  if (context.profiles.empty()) return;
  const ProfileReading reading = read_profile(context.profiles[j], static_cast<int>(j),
                                              context.least_profile, context.summary.profile_level);
  if (reading.verdict == ParameterVerdict::unknown) return;
  const Parameter& p = context.parameters[context.free[j]];
  fitted.verdict = reading.verdict;
  if (!std::isnan(reading.low)) fitted.profile_lo95 = physical_from_unit(p, reading.low);
  if (!std::isnan(reading.high)) fitted.profile_hi95 = physical_from_unit(p, reading.high);
  if (reading.limited_by >= 0) {
    fitted.limited_by =
        context.parameters[context.free[static_cast<std::size_t>(reading.limited_by)]].name;
  }
}

}  // namespace tilth
