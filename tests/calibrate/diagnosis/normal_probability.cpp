// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/normal_probability.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;

TEST_CASE("Normal: logarithm of the distribution function far out in the tail",
          "[calibrate][diagnosis]") {
  REQUIRE_THAT(normal_cdf(-1.959963984540054), WithinRel(0.025, 1e-13));
  REQUIRE_THAT(log_normal_cdf(-5.0), WithinRel(std::log(2.866515718791939e-07), 1e-12));
  // -454.321243... = log Phi(-30) (Mills' ratio to six terms); both branches meet it. 1e-8: the two
  // terms kept beyond -30 err by 2.5 x^-4 = 3e-6 in Phi, 7e-9 of the logarithm.
  REQUIRE_THAT(log_normal_cdf(-29.999999), WithinRel(log_normal_cdf(-30.000001), 2e-7));
  REQUIRE_THAT(log_normal_cdf(-30.000001), WithinRel(-454.3212439, 1e-7));
}

TEST_CASE("Normal: the orthant of two correlated numbers has a closed form",
          "[calibrate][diagnosis]") {
  // Sheppard 1899: P(X <= 0, Y <= 0) = 1/4 + asin(rho) / (2 pi).
  for (const double rho : {-0.999, -0.9, -0.3, 0.0, 0.5, 0.85, 0.99, 0.999})
    REQUIRE_THAT(bivariate_normal_cdf(0.0, 0.0, rho),
                 WithinAbs(0.25 + std::asin(rho) / (2.0 * std::numbers::pi), 1e-12));
  REQUIRE_THAT(bivariate_normal_cdf(1.3, -0.4, 0.0),
               WithinRel(normal_cdf(1.3) * normal_cdf(-0.4), 1e-14));
}

TEST_CASE("Normal: two correlated numbers, against the integral over one of them",
          "[calibrate][diagnosis]") {
  // P = int_-inf^a phi(x) Phi((b - rho x) / sqrt(1 - rho^2)) dx by Simpson with steps of 2e-4:
  // finer than the width 0.03 of the step at rho = 0.999; converged to 1e-11.
  const auto slow = [](double a, double b, double rho) {
    const int num = 60000;
    const double low = a - 12.0;
    const double h = 12.0 / num;
    double sum = 0.0;
    for (int i = 0; i <= num; ++i) {
      const double x = low + h * i;
      const double weight = i == 0 || i == num ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      sum +=
          weight * std::exp(-0.5 * x * x) * normal_cdf((b - rho * x) / std::sqrt(1.0 - rho * rho));
    }
    return sum * h / 3.0 / std::sqrt(2.0 * std::numbers::pi);
  };
  for (const double rho : {-0.999, -0.95, -0.6, 0.3, 0.79, 0.97, 0.999})
    for (const double a : {-2.0, 0.5, 3.0})
      for (const double b : {-1.0, 0.6, 2.0})
        REQUIRE_THAT(bivariate_normal_cdf(a, b, rho), WithinAbs(slow(a, b, rho), 1e-9));
}

TEST_CASE("Normal: tails of chi-square and F agree with tables", "[calibrate][diagnosis]") {
  REQUIRE_THAT(chi_square_tail(7.814727903251179, 3), WithinRel(0.05, 1e-10));
  REQUIRE_THAT(chi_square_tail(4.0, 0), WithinRel(1.0, 1e-15));
  // F(1, 10) at 0.05: 4.9646027437 = t^2; F(28, 30) at 0.01: checked by F = chi-square / 28 at
  // many.
  REQUIRE_THAT(f_tail(4.964602743730711, 1, 10), WithinRel(0.05, 1e-9));
  REQUIRE_THAT(f_tail(7.814727903251179 / 3.0, 3, 1e7), WithinRel(0.05, 1e-5));
}

TEST_CASE("Normal: drawn numbers have mean 0, variance 1 and normal tails",
          "[calibrate][diagnosis]") {
  std::mt19937_64 rng(3);
  const int n = 100000;
  double sum = 0.0;
  double squares = 0.0;
  int beyond = 0;
  for (int i = 0; i < n; ++i) {
    const double x = standard_normal(rng);
    sum += x;
    squares += x * x;
    beyond += std::abs(x) > 1.96;
  }
  // Four standard errors: 1, sqrt(2) and sqrt(0.05 * 0.95) over sqrt(n).
  REQUIRE_THAT(sum / n, WithinAbs(0.0, 0.0127));
  REQUIRE_THAT(squares / n, WithinAbs(1.0, 0.0179));
  REQUIRE_THAT(static_cast<double>(beyond) / n, WithinAbs(0.05, 0.0028));
}
