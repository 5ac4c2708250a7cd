// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/evidence_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/secants.hpp"

namespace tilth {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Mean and variance of the mean, entry by entry, of what is finite; NaN with fewer than two.
class FiniteMeans {
 public:
  FiniteMeans(Eigen::Index rows, Eigen::Index cols)
      : count_(Eigen::MatrixXd::Zero(rows, cols)), sum_(count_), squares_(count_) {}

  void add(Eigen::Index col, const Eigen::VectorXd& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      count_(i, col) += 1.0;
      sum_(i, col) += values[i];
      squares_(i, col) += values[i] * values[i];
    }
  }
  Eigen::MatrixXd means() const {
    return (count_.array() >= 2.0).select(sum_.array() / count_.array(), nan_value);
  }
  Eigen::MatrixXd variances_of_means() const {
    const Eigen::ArrayXXd n = count_.array();
    const Eigen::ArrayXXd spread = (squares_.array() - sum_.array().square() / n).max(0.0);
    return (n >= 2.0).select(spread / (n - 1.0) / n, nan_value);
  }

 private:
  Eigen::MatrixXd count_, sum_, squares_;
};

bool was_skipped(const std::vector<Evaluation>& runs) {
  return std::ranges::any_of(runs, [](const Evaluation& e) { return e.status == EvaluationStatus::skipped; });
}

/// Columns at a point: the base, then every active effect.
struct Members {
  Eigen::MatrixXd points;
  std::vector<Eigen::Index> effects;  ///< of columns 1, 2, ...
};

Members members_at(const Eigen::VectorXd& point, const std::vector<EffectStep>& effects, bool with_costly) {
  Members m{point, {}};
  for (std::size_t k = 0; k < effects.size(); ++k)
    if (effects[k].is_active && (with_costly || !effects[k].is_costly)) m.effects.push_back(static_cast<Eigen::Index>(k));
  m.points = point.replicate(1, 1 + static_cast<Eigen::Index>(m.effects.size()));
  for (std::size_t i = 0; i < m.effects.size(); ++i)
    for (const auto& [column, value] : effects[static_cast<std::size_t>(m.effects[i])].settings)
      m.points(column, static_cast<Eigen::Index>(i) + 1) = value;
  return m;
}

std::optional<Eigen::MatrixXd> packings_at(Evaluator& evaluator, const std::vector<Target>& targets,
                                           const Eigen::VectorXd& point,
                                           const std::vector<std::uint64_t>& seeds) {
  const std::vector<Evaluation> runs =
      evaluator.evaluate(point.replicate(1, static_cast<Eigen::Index>(seeds.size())), seeds);
  if (was_skipped(runs)) return std::nullopt;
  std::vector<Eigen::VectorXd> whole;
  for (const Evaluation& run : runs) {
    const Eigen::VectorXd t = transformed_features(targets, run);
    if (t.allFinite()) whole.push_back(t);
  }
  if (whole.size() < 2) return std::nullopt;
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(whole.size()), static_cast<Eigen::Index>(targets.size()));
  for (std::size_t n = 0; n < whole.size(); ++n) rows.row(static_cast<Eigen::Index>(n)) = whole[n];
  return rows;
}

}  // namespace

Eigen::VectorXd transformed_features(const std::vector<Target>& targets, const Evaluation& run) {
  Eigen::VectorXd t = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(targets.size()), nan_value);
  if (run.status != EvaluationStatus::completed) return t;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double value = run.features[static_cast<Eigen::Index>(k)];
    if (std::isfinite(value)) t[static_cast<Eigen::Index>(k)] = transformed(targets[k], value);
  }
  return t;
}

std::optional<SimulatedEvidence> simulate_evidence(Evaluator& at_point, Evaluator& around,
                                                   const std::vector<Eigen::Index>& compared,
                                                   const std::vector<Parameter>& parameters,
                                                   const std::vector<Target>& targets,
                                                   const Eigen::VectorXd& unit,
                                                   const std::vector<EffectStep>& effects,
                                                   const EvidencePlan& plan) {
  const Eigen::VectorXd point = physical_point(parameters, unit);
  std::optional<Eigen::MatrixXd> packings = packings_at(at_point, targets, point, plan.residual_seeds);
  if (!packings) return std::nullopt;

  const auto p = static_cast<Eigen::Index>(targets.size());
  const auto num_effects = static_cast<Eigen::Index>(effects.size());
  FiniteMeans jacobian(p, unit.size()), fingerprints(p, num_effects);
  const Eigen::VectorXd steps = secant_steps(parameters, plan.log_step, plan.linear_step);
  std::vector<std::string> failures(effects.size());
  for (std::size_t n = 0; n < plan.derivative_seeds.size(); ++n) {
    const std::uint64_t seed = plan.derivative_seeds[n];
    const Members members = members_at(point, effects, n < plan.costly_packings);
    const std::vector<Evaluation> runs = around.evaluate(members.points, seed);
    const std::optional<Secants> secants =
        paired_secants(around, parameters, targets, unit, steps, std::span(&seed, 1));
    if (was_skipped(runs)) return std::nullopt;
    const Eigen::VectorXd base = transformed_features(targets, runs.front());
    if (!secants) continue;  // this packing failed at the point itself
    for (Eigen::Index j = 0; j < unit.size(); ++j)
      if (std::ranges::find(secants->frozen, static_cast<std::size_t>(j)) == secants->frozen.end())
        jacobian.add(j, secants->jacobian.col(j));
    for (std::size_t i = 0; i < members.effects.size(); ++i) {
      const Eigen::Index k = members.effects[i];
      const Evaluation& run = runs[i + 1];
      fingerprints.add(k, (transformed_features(targets, run) - base) / effects[static_cast<std::size_t>(k)].step());
      if (!run.message.empty()) failures[static_cast<std::size_t>(k)] = run.message;
    }
  }

  SimulatedEvidence e{*packings, jacobian.means(), jacobian.variances_of_means(), fingerprints.means(),
                      fingerprints.variances_of_means(), std::move(failures)};
  for (Eigen::Index k = 0; k < num_effects; ++k) {
    std::string& why = e.not_simulated[static_cast<std::size_t>(k)];
    if (!effects[static_cast<std::size_t>(k)].is_active) why = "none of these tests depends on it";
    else if (e.fingerprints.col(k)(compared).allFinite()) why.clear();
    else if (why.empty()) why = "fewer than two packings could be compared";
  }
  return e;
}

}  // namespace tilth
