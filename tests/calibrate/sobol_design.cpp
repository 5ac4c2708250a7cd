// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/sobol_design.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

using namespace tilth;

TEST_CASE("Sobol: the first points are those of the published sequence", "[calibrate][sobol]") {
  // Joe & Kuo, sobol program with new-joe-kuo-6.21201, first ten points in three dimensions.
  const std::vector<std::vector<double>> published = {{0, 0, 0},
                                                      {0.5, 0.5, 0.5},
                                                      {0.75, 0.25, 0.25},
                                                      {0.25, 0.75, 0.75},
                                                      {0.375, 0.375, 0.625},
                                                      {0.875, 0.875, 0.125},
                                                      {0.625, 0.125, 0.875},
                                                      {0.125, 0.625, 0.375},
                                                      {0.1875, 0.3125, 0.9375},
                                                      {0.6875, 0.8125, 0.4375}};
  const Eigen::MatrixXd points = sobol_points(10, 3);
  for (int i = 0; i < 10; ++i) {
    for (int d = 0; d < 3; ++d) {
      // Exact: dyadic numbers.
      REQUIRE(points(d, i) == published[static_cast<std::size_t>(i)][static_cast<std::size_t>(d)]);
    }
  }
}

TEST_CASE("Sobol: in every dimension the first 2^k points fill 2^k strata, shifted or not",
          "[calibrate][sobol]") {
  for (const bool is_shifted : {false, true}) {
    for (const int n : {2, 16, 256, 1024}) {
      const Eigen::MatrixXd points = is_shifted ? shifted_sobol_points(n, max_sobol_dimensions, 42)
                                                : sobol_points(n, max_sobol_dimensions);
      for (int d = 0; d < max_sobol_dimensions; ++d) {
        std::set<int> strata;
        for (int i = 0; i < n; ++i) strata.insert(static_cast<int>(std::floor(points(d, i) * n)));
        REQUIRE(static_cast<int>(strata.size()) == n);
        REQUIRE(*strata.begin() == 0);
        REQUIRE(*strata.rbegin() == n - 1);
      }
    }
  }
}

TEST_CASE("Sobol: a shift depends on the seed alone and keeps off the faces of the cube",
          "[calibrate][sobol]") {
  const Eigen::MatrixXd points = shifted_sobol_points(64, 5, 3);
  REQUIRE(points == shifted_sobol_points(64, 5, 3));
  REQUIRE(points != shifted_sobol_points(64, 5, 4));
  REQUIRE(points.leftCols(20) == shifted_sobol_points(20, 5, 3));  // extendable
  REQUIRE(points.minCoeff() > 0.0);
  REQUIRE(points.maxCoeff() < 1.0);
}
