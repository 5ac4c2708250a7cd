// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The 27 nonlinear regression problems of NIST, through fit() and its evaluator, from both starts.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <iostream>

#include "calibrate/fit.hpp"
#include "tests/calibrate/nist_problems.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

struct Digits {
  double parameters = 11.0;  // the worst of all
  double standard_deviations = 11.0;
  double sum_of_squares = 11.0;
};

Digits digits_of(const NistProblem& problem, const FitSummary& summary) {
  Digits digits;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const NistParameter& b = problem.parameters[j];
    const FittedParameter& found = summary.parameters[j];
    digits.parameters = std::min(digits.parameters, correct_digits(found.value, b.certified));
    digits.standard_deviations = std::min(
        digits.standard_deviations, correct_digits(found.standard_error, b.standard_deviation));
  }
  digits.sum_of_squares = correct_digits(summary.chi_square, problem.residual_sum_of_squares);
  return digits;
}

FitSummary solved(const NistProblem& problem, std::size_t start) {
  return fit(nist_parameters(problem, start), nist_targets(problem), nist_simulator(problem),
             nullptr, nist_options());
}

}  // namespace

TEST_CASE("NIST: six digits of the parameters and four of the standard deviations from both starts",
          "[calibrate][nist]") {
  const std::vector<NistProblem> problems = nist_problems();
  REQUIRE(problems.size() == 27);
  for (const NistProblem& problem : problems) {
    for (const std::size_t start : {0, 1}) {
      const FitSummary summary = solved(problem, start);
      const Digits digits = digits_of(problem, summary);
      INFO(problem.name << " from start " << start + 1 << ": " << summary.message);
      CHECK(digits.parameters >= 6.0);
      CHECK(digits.standard_deviations >= 4.0);
      CHECK(summary.degrees_of_freedom == problem.degrees_of_freedom);
    }
  }
}

// The table of docs/benchmarks.md: tilth_tests "NIST: table of digits".
TEST_CASE("NIST: table of digits", "[.][nist_table]") {
  for (const NistProblem& problem : nist_problems()) {
    std::string row = fmt::format("| {} ", problem.name);
    for (const std::size_t start : {0, 1}) {
      const FitSummary summary = solved(problem, start);
      const Digits digits = digits_of(problem, summary);
      row += fmt::format("| {:.1f} | {:.1f} | {:.1f} | {} ", digits.parameters,
                         digits.standard_deviations, digits.sum_of_squares,
                         summary.starts.front().num_iterations);
    }
    std::cout << row << "|\n";
  }
}
