// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The 27 nonlinear regression problems of NIST as fit problems.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibrate/fit_options.hpp"
#include "calibrate/fit_summary.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/simulator.hpp"
#include "calibrate/targets.hpp"

namespace tilth::test {

struct NistParameter {
  std::string name;
  double starts[2] = {0.0, 0.0};
  double certified = 0.0;
  double standard_deviation = 0.0;
};

/// One set of tests/reference/nist_strd.
struct NistProblem {
  std::string name;
  std::vector<NistParameter> parameters;
  int degrees_of_freedom = 0;
  double residual_sum_of_squares = 0.0;
  std::vector<long double> y, x1, x2;
};

/// All 27, in the order of problems.csv. @throws std::runtime_error if a file cannot be read
std::vector<NistProblem> nist_problems();
const NistProblem& nist_problem(const std::vector<NistProblem>& problems, const std::string& name);

/// Bounds as far away as 100 times the larger start on both sides of zero. The exponential sums of
/// Lanczos have positive terms, bounds 0 and twice the larger start: a coordinate is resolved to
/// 1e-16 of its range, and Lanczos1 needs 1e-15.
std::vector<Parameter> nist_parameters(const NistProblem& problem, std::size_t start);

/// Every feature is model minus observation, evaluated in extended precision (64 bits of mantissa)
/// and only then rounded: Lanczos1's residuals are 1e-13 of its observations.
Simulator nist_simulator(const NistProblem& problem);

/// Differences of zero, sigma 1 up to the common factor that rescale_sigma finds.
std::vector<Target> nist_targets(const NistProblem& problem);

/// smooth_fit_options() with rescaled sigma and no profiles.
FitOptions nist_options();

/// Correct digits, -log10 |found / certified - 1|, at most 11 (what is certified); 0 if none.
double correct_digits(double found, double certified);

}  // namespace tilth::test
