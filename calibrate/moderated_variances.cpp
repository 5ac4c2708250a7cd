// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/moderated_variances.hpp"

#include <algorithm>

namespace tilth {

Eigen::VectorXd sample_variances(const Eigen::MatrixXd& samples) {
  if (samples.cols() < 2) return Eigen::VectorXd::Zero(samples.rows());
  const Eigen::MatrixXd rest = samples.colwise() - samples.rowwise().mean();
  return rest.rowwise().squaredNorm() / static_cast<double>(samples.cols() - 1);
}

Eigen::VectorXd moderated_variances(const Eigen::MatrixXd& samples, const Eigen::VectorXd& prior,
                                    double prior_freedom) {
  const auto freedom = static_cast<double>(std::max<Eigen::Index>(0, samples.cols() - 1));
  return (prior_freedom * prior + freedom * sample_variances(samples)) / (prior_freedom + freedom);
}

}  // namespace tilth
