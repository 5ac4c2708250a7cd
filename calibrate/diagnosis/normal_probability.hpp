// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The few probabilities of the normal distribution that the diagnosis needs.
#pragma once

#include <random>

namespace tilth {

/// Phi(x) = P(N(0, 1) <= x).
double normal_cdf(double x);

/// log Phi(x), also where Phi(x) itself is too small for a double.
/// Below -30 the first two terms of Mills' ratio: relative error of Phi under 2e-6.
/// @source Abramowitz & Stegun 1964, 26.2.12
double log_normal_cdf(double x);

/// The x with Phi(x) = probability.  @pre 0 < probability < 1
double normal_quantile(double probability);

/// P(chi-square with `freedom` degrees > x); 1 where freedom is 0.
/// @source Q(freedom / 2, x / 2), the regularised upper incomplete gamma function
double chi_square_tail(double x, double freedom);

/// P(F > f) of Fisher's distribution; 1 where freedom_1 is 0.
/// @source I_x(freedom_2 / 2, freedom_1 / 2), x = freedom_2 / (freedom_2 + freedom_1 f)
double f_tail(double f, double freedom_1, double freedom_2);

/// P(X <= a, Y <= b) of two standard normal numbers with correlation rho, |rho| < 1.
///
///   Phi(a) Phi(b) + 1/(2 pi) int_0^asin(rho) exp(-(a^2 + b^2 - 2 a b sin t) / (2 cos^2 t)) dt
///
/// By Gauss-Legendre on panels that get finer with |rho|; absolute error below 1e-9 for
/// |rho| <= 0.999 (test), and never below 1e-16, since its logarithm is taken.
/// @source Plackett, Biometrika 41 (1954) 351; Drezner & Wesolowsky 1990
double bivariate_normal_cdf(double a, double b, double rho);

/// One standard normal number: the quantile function at a uniform word, so that the same seed gives
/// the same numbers with every standard library.
double standard_normal(std::mt19937_64& rng);

}  // namespace tilth
