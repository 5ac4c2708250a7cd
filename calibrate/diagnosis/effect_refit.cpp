// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/effect_refit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "calibrate/diagnosis/evidence_runs.hpp"

namespace tilth {
namespace {

/// All unknowns: unit coordinates, then sizes over their ranges, each in [0, 1].
class Unknowns {
 public:
  Unknowns(const RefitProblem& problem, const std::vector<FreeEffect>& effects)
      : problem_(problem), effects_(effects) {}

  Eigen::VectorXd from(const Eigen::VectorXd& unit, const Eigen::VectorXd& sizes) const {
    Eigen::VectorXd x(unit.size() + sizes.size());
    x.head(unit.size()) = unit;
    for (Eigen::Index k = 0; k < sizes.size(); ++k)
      x[unit.size() + k] = (sizes[k] - effect(k).lower) / range(k);
    return clipped(x);
  }
  Eigen::VectorXd unit(const Eigen::VectorXd& x) const { return x.head(num_free()); }
  Eigen::VectorXd sizes(const Eigen::VectorXd& x) const {
    Eigen::VectorXd s(x.size() - num_free());
    for (Eigen::Index k = 0; k < s.size(); ++k) s[k] = effect(k).lower + range(k) * x[num_free() + k];
    return s;
  }
  Eigen::VectorXd point(const Eigen::VectorXd& x) const {
    Eigen::VectorXd v = physical_point(problem_.parameters, unit(x));
    const Eigen::VectorXd s = sizes(x);
    for (Eigen::Index k = 0; k < s.size(); ++k) {
      v[effect(k).column] = s[k];
      for (const auto& [column, value] : effect(k).nuisance) v[column] = value;
    }
    return v;
  }
  /// d T / d x of the fitted targets.
  Eigen::MatrixXd derivatives() const {
    Eigen::MatrixXd all(problem_.jacobian.rows(), num_free() + static_cast<Eigen::Index>(effects_.size()));
    all.leftCols(num_free()) = problem_.jacobian;
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(effects_.size()); ++k)
      all.col(num_free() + k) = effect(k).fingerprint * range(k);
    return all(problem_.fitted, Eigen::all);
  }
  static Eigen::VectorXd clipped(const Eigen::VectorXd& x) { return x.cwiseMax(0.0).cwiseMin(1.0); }

 private:
  Eigen::Index num_free() const { return problem_.jacobian.cols(); }
  const FreeEffect& effect(Eigen::Index k) const { return effects_[static_cast<std::size_t>(k)]; }
  double range(Eigen::Index k) const { return effect(k).upper - effect(k).lower; }

  const RefitProblem& problem_;
  const std::vector<FreeEffect>& effects_;
};

/// Least squares in the box: unknowns that would leave it are held at its edge and the rest solved again.
Eigen::VectorXd boxed_step(const Eigen::MatrixXd& a, const Eigen::VectorXd& r, const Eigen::VectorXd& x) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(x.size());
  std::vector<Eigen::Index> open(static_cast<std::size_t>(x.size()));
  for (std::size_t j = 0; j < open.size(); ++j) open[j] = static_cast<Eigen::Index>(j);
  Eigen::VectorXd left = r;
  while (!open.empty()) {
    const Eigen::MatrixXd sub = a(Eigen::all, open);
    const Eigen::VectorXd s = sub.completeOrthogonalDecomposition().solve(left);
    std::vector<Eigen::Index> inside;
    for (std::size_t j = 0; j < open.size(); ++j) {
      const double at = x[open[j]] + s[static_cast<Eigen::Index>(j)];
      if (at >= 0.0 && at <= 1.0) inside.push_back(open[j]);
    }
    if (inside.size() == open.size()) {
      for (std::size_t j = 0; j < open.size(); ++j) step[open[j]] = s[static_cast<Eigen::Index>(j)];
      return step;
    }
    for (std::size_t j = 0; j < open.size(); ++j) {
      const double at = x[open[j]] + s[static_cast<Eigen::Index>(j)];
      if (at >= 0.0 && at <= 1.0) continue;
      step[open[j]] = std::clamp(at, 0.0, 1.0) - x[open[j]];
      left -= a.col(open[j]) * step[open[j]];
    }
    open = inside;
  }
  return step;
}

/// Mean T over the packings that have all numbers; empty vector if there is none.
Eigen::VectorXd mean_at(Evaluator& evaluator, const RefitProblem& problem, const Eigen::VectorXd& point) {
  const std::vector<Evaluation> runs = evaluator.evaluate(
      point.replicate(1, static_cast<Eigen::Index>(problem.seeds.size())), problem.seeds);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(problem.measured.size());
  double num = 0.0;
  for (const Evaluation& run : runs) {
    const Eigen::VectorXd t = transformed_features(problem.targets, run);
    if (!t.allFinite()) continue;
    sum += t;
    num += 1.0;
  }
  return num > 0.0 ? Eigen::VectorXd(sum / num) : Eigen::VectorXd();
}

}  // namespace

Refit refit(Evaluator& evaluator, const RefitProblem& problem, const Eigen::VectorXd& unit,
            const std::vector<FreeEffect>& effects, const Eigen::VectorXd& sizes, int max_steps) {
  const Unknowns unknowns(problem, effects);
  const Eigen::MatrixXd v = problem.covariance(problem.fitted, problem.fitted);
  const Eigen::LLT<Eigen::MatrixXd> root(v);
  const auto whitened_fitted = [&](const Eigen::VectorXd& residual) {
    return Eigen::VectorXd(root.matrixL().solve(Eigen::VectorXd(residual(problem.fitted))));
  };
  const Eigen::MatrixXd a = root.matrixL().solve(unknowns.derivatives());

  Refit best;
  Eigen::VectorXd x = unknowns.from(unit, sizes), best_x = x;
  double share = 1.0;
  for (int k = 0; k < max_steps; ++k) {
    const Eigen::VectorXd mean = mean_at(evaluator, problem, unknowns.point(x));
    ++best.num_steps;
    if (mean.size() > 0) {
      const Eigen::VectorXd residual = problem.measured - mean;
      const double chi_square = whitened_fitted(residual).squaredNorm();
      const bool is_better = !best.is_usable || chi_square < best.chi_square;
      if (is_better) {
        const double drop = best.is_usable ? best.chi_square - chi_square : chi_square;
        best.is_usable = true;
        best.residual = residual;
        best.chi_square = chi_square;
        best_x = x;
        share = 1.0;
        if (k > 0 && drop < 0.1) break;  // a tenth of chi-square: far below the noise of one number
      } else {
        share *= 0.5;
      }
    } else {
      share *= 0.5;
    }
    if (!best.is_usable || share < 0.2) break;
    x = Unknowns::clipped(best_x + share * boxed_step(a, whitened_fitted(best.residual), best_x));
    if ((x - best_x).cwiseAbs().maxCoeff() < 1e-3) break;
  }
  best.unit = unknowns.unit(best_x);
  best.sizes = unknowns.sizes(best_x);
  return best;
}

}  // namespace tilth
