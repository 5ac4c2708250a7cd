// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Nineteen least-squares problems of More, Garbow & Hillstrom as fit problems.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace tilth::test {

/// Residuals as a formula; all targets are zero with sigma 1.
struct MghProblem {
  std::string name;
  std::vector<double> start;
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> residuals;
  std::vector<double> sums_of_squares;  ///< published minima, the global one first
  // The bounded version; empty if none is published with its optimum.
  std::vector<double> lower, upper;
  double bounded_sum_of_squares = 0.0;
  int bounded_num_residuals = 0;  ///< the bounded version takes only the first ones; 0 = all
};

/// @source More, Garbow & Hillstrom, ACM Trans. Math. Softw. 7 (1981) 17; bounds and bounded minima
///         Gay, Lecture Notes in Mathematics 1066 (1984) 72, as listed by A. Neumaier
std::vector<MghProblem> mgh_problems();

}  // namespace tilth::test
