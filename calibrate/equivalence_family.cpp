// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/equivalence_family.hpp"

namespace tilth {

std::vector<Eigen::Index> farthest_columns(const Eigen::MatrixXd& points, int most,
                                           double least_distance) {
  std::vector<Eigen::Index> chosen;
  if (points.cols() == 0 || most < 1) return chosen;
  chosen.push_back(0);
  Eigen::VectorXd nearest = (points.colwise() - points.col(0)).colwise().norm();
  while (static_cast<int>(chosen.size()) < most) {
    Eigen::Index next = 0;
    if (nearest.maxCoeff(&next) <= least_distance) break;
    chosen.push_back(next);
    const Eigen::VectorXd to_next = (points.colwise() - points.col(next)).colwise().norm();
    nearest = nearest.cwiseMin(to_next);
  }
  return chosen;
}

}  // namespace tilth
