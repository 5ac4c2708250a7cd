// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/separability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/diagnosis/thresholds.hpp"

namespace tilth {
namespace {

struct Separation {
  double least = std::numeric_limits<double>::infinity();
  double ordering = 1.0;  // of that pair
  double capped_mean = 0.0;
};

Separation separation_of(const ProjectedEvidence& evidence,
                         const std::vector<std::size_t>& contenders, const Eigen::VectorXd& sizes) {
  const Eigen::MatrixXd rho = look_alike_map(evidence);
  const Eigen::VectorXd lambda = noncentralities(evidence, sizes);
  const auto num_pairs = static_cast<double>(contenders.size() * (contenders.size() - 1));
  Separation result;
  for (const std::size_t i : contenders)
    for (const std::size_t j : contenders) {
      const auto a = static_cast<Eigen::Index>(i);
      if (i == j) continue;
      const double r = rho(a, static_cast<Eigen::Index>(j));
      const double separation = lambda[a] * (1.0 - std::abs(r));
      result.capped_mean +=
          std::min(diagnosis_thresholds::separable_lambda, separation) / num_pairs;
      if (separation >= result.least) continue;
      result.least = separation;
      result.ordering = ordering_probability(lambda[a], r);
    }
  return result;
}

LinearModel extended(const LinearModel& model, const LinearModel& more) {
  const auto below = [](const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) {
    if (top.cols() != bottom.cols())
      throw std::invalid_argument(
          "a possible experiment has other parameters or effects than the "
          "model it would be added to");
    Eigen::MatrixXd both(top.rows() + bottom.rows(), top.cols());
    both << top, bottom;
    return both;
  };
  LinearModel joint = model;
  joint.statistics.insert(joint.statistics.end(), more.statistics.begin(), more.statistics.end());
  joint.jacobian = below(model.jacobian, more.jacobian);
  joint.fingerprints = below(model.fingerprints, more.fingerprints);
  const auto noise_below = [&](const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) {
    return top.size() > 0 && bottom.size() > 0 ? below(top, bottom) : Eigen::MatrixXd();
  };
  joint.fingerprint_variances =
      noise_below(model.fingerprint_variances, more.fingerprint_variances);
  joint.jacobian_variances = noise_below(model.jacobian_variances, more.jacobian_variances);
  return joint;
}

ProjectedEvidence extended_evidence(const LinearModel& model, const Eigen::MatrixXd& covariance,
                                    const PossibleExperiment& experiment) {
  const Eigen::Index p = covariance.rows();
  const Eigen::Index all = p + experiment.covariance.rows();
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(all, all);
  joint.topLeftCorner(p, p) = covariance;
  joint.bottomRightCorner(all - p, all - p) = experiment.covariance;
  return project(extended(model, experiment.model), Eigen::VectorXd::Zero(all), joint);
}

}  // namespace

double ordering_probability(double lambda, double rho) {
  const double a = normal_cdf(std::sqrt(0.5 * lambda * (1.0 - rho)));
  const double b = normal_cdf(std::sqrt(0.5 * lambda * (1.0 + rho)));
  return a * b + (1.0 - a) * (1.0 - b);
}

Eigen::MatrixXd look_alike_map(const ProjectedEvidence& evidence) {
  Eigen::MatrixXd unit = evidence.fingerprints;
  for (Eigen::Index k = 0; k < unit.cols(); ++k)
    unit.col(k) *= evidence.is_measurable(k) ? 1.0 / unit.col(k).norm() : 0.0;
  Eigen::MatrixXd rho = unit.transpose() * unit;
  rho.diagonal().setOnes();
  return rho.cwiseMin(1.0).cwiseMax(-1.0);
}

Eigen::VectorXd noncentralities(const ProjectedEvidence& evidence, const Eigen::VectorXd& sizes) {
  return sizes.array().square() * evidence.fingerprints.colwise().squaredNorm().transpose().array();
}

bool is_separable(double lambda, double rho) {
  return lambda * (1.0 - std::abs(rho)) >= diagnosis_thresholds::separable_lambda;
}

std::vector<std::vector<std::size_t>> look_alike_groups(const Eigen::MatrixXd& look_alikes,
                                                        const Eigen::VectorXd& lambda,
                                                        const std::vector<std::size_t>& effects) {
  const auto linked = [&](std::size_t i, std::size_t j) {
    const auto a = static_cast<Eigen::Index>(i);
    const auto b = static_cast<Eigen::Index>(j);
    return !is_separable(lambda[a], look_alikes(a, b)) ||
           !is_separable(lambda[b], look_alikes(a, b));
  };
  std::vector<std::size_t> open = effects;
  std::ranges::sort(open);
  std::vector<std::vector<std::size_t>> groups;
  while (!open.empty()) {
    std::vector<std::size_t> group = {open.front()};
    open.erase(open.begin());
    for (std::size_t member = 0; member < group.size(); ++member)
      for (auto it = open.begin(); it != open.end();) {
        const bool joins = linked(group[member], *it);
        if (joins) group.push_back(*it);
        it = joins ? open.erase(it) : it + 1;
      }
    std::ranges::sort(group);
    groups.push_back(group);
  }
  return groups;
}

std::vector<ExperimentAdvice> next_experiments(const LinearModel& model,
                                               const Eigen::MatrixXd& covariance,
                                               const std::vector<std::size_t>& contenders,
                                               const Eigen::VectorXd& sizes,
                                               const std::vector<PossibleExperiment>& possible) {
  if (contenders.size() < 2) return {};
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(covariance.rows());
  const Separation now = separation_of(project(model, nothing, covariance), contenders, sizes);
  std::vector<ExperimentAdvice> advice;
  for (const PossibleExperiment& experiment : possible) {
    const Separation then =
        separation_of(extended_evidence(model, covariance, experiment), contenders, sizes);
    advice.push_back({experiment.name, now.least, then.least, now.ordering, then.ordering,
                      (then.least - now.least) / experiment.cost,
                      (then.capped_mean - now.capped_mean) / experiment.cost});
  }
  constexpr double tie = 1e-9;  // rounding of separations of order one
  std::ranges::stable_sort(advice, [](const ExperimentAdvice& a, const ExperimentAdvice& b) {
    if (std::abs(a.gain_per_cost - b.gain_per_cost) > tie) return a.gain_per_cost > b.gain_per_cost;
    return a.mean_gain_per_cost > b.mean_gain_per_cost;
  });
  return advice;
}

}  // namespace tilth
