// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/gap_size.hpp"

#include <algorithm>
#include <cmath>

namespace tilth {

double gap_size(const Eigen::VectorXd& residual, const Eigen::VectorXd& variances) {
  if (residual.size() == 0) return 0.0;
  return std::sqrt(std::max(0.0, (residual.array().square() - variances.array()).mean()));
}

std::optional<double> closure(double gap_before, double gap_after) {
  if (!(gap_before > 0.0)) return std::nullopt;
  return 1.0 - gap_after / gap_before;
}

}  // namespace tilth
