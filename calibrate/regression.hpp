// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The scatter of measurements about a smooth trend, where there are no repeats.
#pragma once

#include <Eigen/Core>

namespace tilth {

struct Regression {
  Eigen::VectorXd coefficients;  ///< one per regressor
  double scatter = 0.0;          ///< sqrt(RSS / (n - k))
  int degrees_of_freedom = 0;    ///< n - k
};

/// Ordinary least squares y = X b by QR.
/// @shape regressors (n, k) of full rank, k < n; y (n)
/// @throws std::invalid_argument where n <= k or the rank is short
Regression regress(const Eigen::MatrixXd& regressors, const Eigen::VectorXd& y);

}  // namespace tilth
