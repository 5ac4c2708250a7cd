// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/regression.hpp"

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

namespace tilth {

Regression regress(const Eigen::MatrixXd& regressors, const Eigen::VectorXd& y) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(regressors);
  const Eigen::Index spare = regressors.rows() - regressors.cols();
  if (spare <= 0 || qr.rank() < regressors.cols())
    throw std::invalid_argument("a regression needs more tests than coefficients, and tests that "
                                "differ in every regressor");
  Regression r;
  r.coefficients = qr.solve(y);
  r.degrees_of_freedom = static_cast<int>(spare);
  r.scatter = std::sqrt((y - regressors * r.coefficients).squaredNorm() /
                        static_cast<double>(spare));
  return r;
}

}  // namespace tilth
