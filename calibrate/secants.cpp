// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/secants.hpp"

#include <algorithm>

#include "calibrate/seed_average.hpp"

namespace tilth {
namespace {

using Mean = std::optional<Eigen::VectorXd>;

// One batch: the base, then a plus and a minus member per parameter where they fit in the cube.
struct Members {
  Eigen::MatrixXd points;
  std::vector<int> plus;   // column of u + h e_j, or -1
  std::vector<int> minus;  // column of u - h e_j, or -1
};

Members members_around(const Eigen::VectorXd& unit, const Eigen::VectorXd& steps) {
  const Eigen::Index q = unit.size();
  Members members{unit.replicate(1, 2 * q + 1), std::vector<int>(static_cast<std::size_t>(q), -1),
                  std::vector<int>(static_cast<std::size_t>(q), -1)};
  int next = 1;
  for (Eigen::Index j = 0; j < q; ++j) {
    const auto index = static_cast<std::size_t>(j);
    if (unit[j] + steps[j] <= 1.0) {
      members.points(j, next) += steps[j];
      members.plus[index] = next++;
    }
    if (unit[j] - steps[j] >= 0.0) {
      members.points(j, next) -= steps[j];
      members.minus[index] = next++;
    }
  }
  members.points.conservativeResize(Eigen::NoChange, next);
  return members;
}

// base_share[j]: what the derivative takes of the run at the point itself.
void fill_column(Secants& secants, std::size_t j, double step, const Mean& plus, const Mean& minus,
                 Eigen::VectorXd& base_share) {
  const auto index = static_cast<Eigen::Index>(j);
  auto column = secants.jacobian.col(index);
  if (plus && minus) {
    column = (*plus - *minus) / (2.0 * step);
    secants.noise_shape(index, index) = 0.5 / (step * step);
    const Eigen::Index num = secants.second_differences.cols();
    secants.second_differences.conservativeResize(column.size(), num + 1);
    secants.second_differences.col(num) = *plus - 2.0 * secants.base + *minus;
    return;
  }
  if (plus) {
    column = (*plus - secants.base) / step;
    base_share[index] = -1.0 / step;
  } else if (minus) {
    column = (secants.base - *minus) / step;
    base_share[index] = 1.0 / step;
  } else {
    secants.frozen.push_back(j);
    return;
  }
  secants.noise_shape(index, index) = 1.0 / (step * step);
  secants.one_sided.push_back(j);
}

}  // namespace

Eigen::VectorXd secant_steps(std::span<const Parameter> parameters, double log_step,
                             double linear_step) {
  const std::vector<std::size_t> free = free_parameters(parameters);
  Eigen::VectorXd steps(static_cast<Eigen::Index>(free.size()));
  for (std::size_t j = 0; j < free.size(); ++j) {
    const Parameter& p = parameters[free[j]];
    const double span = coordinate_span(p);
    const double step = p.log_scale ? log_step / span : linear_step;
    // At most a quarter of the range, so that one side always lies inside the cube.
    steps[static_cast<Eigen::Index>(j)] =
        std::min(0.25, p.secant_step ? *p.secant_step / span : step);
  }
  return steps;
}

std::optional<Secants> paired_secants(Evaluator& evaluator, std::span<const Parameter> parameters,
                                      std::span<const Target> targets, const Eigen::VectorXd& unit,
                                      const Eigen::VectorXd& steps,
                                      std::span<const std::uint64_t> seeds) {
  const Members members = members_around(unit, steps);
  const std::vector<Mean> means =
      average_over_seeds(evaluator, parameters, targets, members.points, seeds);
  if (!means.front()) return std::nullopt;

  Secants secants;
  secants.base = *means.front();
  secants.jacobian = Eigen::MatrixXd::Zero(secants.base.size(), unit.size());
  secants.second_differences.resize(secants.base.size(), 0);
  secants.noise_shape = Eigen::MatrixXd::Zero(unit.size(), unit.size());
  Eigen::VectorXd base_share = Eigen::VectorXd::Zero(unit.size());
  const auto mean_at = [&](int column) {
    return column < 0 ? Mean{} : means[static_cast<std::size_t>(column)];
  };
  for (std::size_t j = 0; j < members.plus.size(); ++j) {
    fill_column(secants, j, steps[static_cast<Eigen::Index>(j)], mean_at(members.plus[j]),
                mean_at(members.minus[j]), base_share);
  }
  secants.noise_shape += base_share * base_share.transpose();
  return secants;
}

}  // namespace tilth
