// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/optimise_ceres.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <exception>
#include <limits>

namespace tilth {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// One parameter block, one residual block. Ceres has no word for exceptions: they are kept here
// and thrown again after the solve.
class ProblemCost : public ceres::CostFunction {
 public:
  ProblemCost(const LeastSquaresProblem& problem, Eigen::Index num_parameters, double least_step)
      : problem_(problem), least_step_(least_step), x_(num_parameters) {
    set_num_residuals(problem.num_residuals);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(num_parameters));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    try {
      return evaluate(parameters[0], residuals, jacobians != nullptr ? jacobians[0] : nullptr);
    } catch (...) {
      thrown_ = std::current_exception();
      return false;
    }
  }

  bool can_evaluate(const Eigen::VectorXd& x) const {
    Eigen::VectorXd r(num_residuals());
    Eigen::MatrixXd j(num_residuals(), x.size());
    return problem_.evaluate(x, r, &j);
  }
  const std::exception_ptr& thrown() const { return thrown_; }
  /// Was a trial left out because its step was too short?
  bool ended_by_short_step() const { return short_step_; }
  /// The best point evaluated: Ceres forgets its own after a failure.
  const Eigen::VectorXd& best() const { return best_; }
  double best_sum_of_squares() const { return best_sum_of_squares_; }

 private:
  bool evaluate(const double* x, double* residuals, double* jacobian) const {
    if (thrown_) return false;
    x_ = Eigen::Map<const Eigen::VectorXd>(x, x_.size());
    short_step_ = short_step_ || (jacobian == nullptr && is_short_step());
    if (short_step_) return false;
    Eigen::VectorXd r(num_residuals());
    Eigen::MatrixXd j(num_residuals(), x_.size());
    if (!problem_.evaluate(x_, r, jacobian != nullptr ? &j : nullptr)) return false;
    if (!(r.squaredNorm() >= best_sum_of_squares_)) {
      best_ = x_;
      best_sum_of_squares_ = r.squaredNorm();
    }
    Eigen::Map<Eigen::VectorXd>(residuals, r.size()) = r;
    if (jacobian != nullptr) {
      base_ = x_;
      hold_at_bounds(r, j);
      Eigen::Map<RowMajor>(jacobian, j.rows(), j.cols()) = j;
    }
    return true;
  }

  bool is_short_step() const {
    if (least_step_ <= 0.0 || base_.size() == 0) return false;
    const double step = (x_ - base_).lpNorm<Eigen::Infinity>();
    return step > 0.0 && step < least_step_;
  }

  // A parameter at its bound that descent would push outside is held for this step (Bertsekas
  // 1982). Otherwise the step of the others counts on a move that the projection takes back, and
  // the search creeps along the bound.
  void hold_at_bounds(const Eigen::VectorXd& r, Eigen::MatrixXd& j) const {
    const Eigen::VectorXd gradient = j.transpose() * r;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      const bool leaves_below = x_[i] <= problem_.lower[i] && gradient[i] > 0.0;
      const bool leaves_above = x_[i] >= problem_.upper[i] && gradient[i] < 0.0;
      if (leaves_below || leaves_above) j.col(i).setZero();
    }
  }

  const LeastSquaresProblem& problem_;
  double least_step_;
  mutable Eigen::VectorXd x_;
  mutable Eigen::VectorXd base_;  // where steps start from; empty before the first Jacobian
  mutable bool short_step_ = false;
  mutable Eigen::VectorXd best_;
  mutable double best_sum_of_squares_ = std::numeric_limits<double>::quiet_NaN();
  mutable std::exception_ptr thrown_;
};

// Books the history and ends the search by our own rules.
class Watch : public ceres::IterationCallback {
 public:
  Watch(const LeastSquaresOptions& options, LeastSquaresResult& result)
      : options_(options), result_(result) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    if (iteration.iteration == 0 || iteration.step_is_successful) {
      result_.history.push_back(2.0 * iteration.cost);
    }
    if (options_.should_stop && options_.should_stop()) {
      stopped_ = true;
      return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    }
    if (iteration.iteration > 0 && iteration.step_is_successful &&
        2.0 * iteration.cost_change < options_.absolute_tolerance) {
      return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    }
    return ceres::SOLVER_CONTINUE;
  }

  bool stopped() const { return stopped_; }

 private:
  const LeastSquaresOptions& options_;
  LeastSquaresResult& result_;
  bool stopped_ = false;
};

ceres::Solver::Options solver_options(const LeastSquaresOptions& options, Watch& watch) {
  ceres::Solver::Options solver;
  solver.minimizer_type = ceres::TRUST_REGION;
  solver.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  solver.linear_solver_type = ceres::DENSE_QR;
  // The default (cubic) would ask for a Jacobian at every trial point of a bounded search.
  solver.line_search_interpolation_type = ceres::QUADRATIC;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.callbacks.push_back(&watch);
  return solver;
}

void set_bounds(ceres::Problem& solver_problem, double* x, const LeastSquaresProblem& problem) {
  for (Eigen::Index i = 0; i < problem.lower.size(); ++i) {
    const int index = static_cast<int>(i);
    if (std::isfinite(problem.lower[i])) {
      solver_problem.SetParameterLowerBound(x, index, problem.lower[i]);
    }
    if (std::isfinite(problem.upper[i])) {
      solver_problem.SetParameterUpperBound(x, index, problem.upper[i]);
    }
  }
}

}  // namespace

LeastSquaresResult minimise_with_ceres(const LeastSquaresProblem& problem,
                                       const Eigen::VectorXd& start,
                                       const LeastSquaresOptions& options) {
  LeastSquaresResult result;
  Eigen::VectorXd x = start;
  ProblemCost cost(problem, start.size(), options.least_step);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem solver_problem(ownership);
  solver_problem.AddResidualBlock(&cost, nullptr, x.data());
  set_bounds(solver_problem, x.data(), problem);

  const double unknown = std::numeric_limits<double>::quiet_NaN();
  result.x = start;
  result.sum_of_squares = result.sum_of_squares_start = unknown;
  result.message = "the start could not be evaluated";
  if (!cost.can_evaluate(start)) return result;  // Ceres would write to the log

  Watch watch(options, result);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options, watch), &solver_problem, &summary);
  if (cost.thrown()) std::rethrow_exception(cost.thrown());

  result.usable = !result.history.empty();
  result.message = watch.stopped()              ? "stopped"
                   : cost.ended_by_short_step() ? "the next step is too short to be judged"
                                                : summary.message;
  if (!result.usable) return result;
  result.converged = !watch.stopped() && (cost.ended_by_short_step() ||
                                          summary.termination_type == ceres::CONVERGENCE ||
                                          summary.termination_type == ceres::USER_SUCCESS);
  result.num_iterations = static_cast<int>(result.history.size()) - 1;
  result.x = cost.best();
  result.sum_of_squares_start = result.history.front();
  result.sum_of_squares = cost.best_sum_of_squares();
  return result;
}

}  // namespace tilth
