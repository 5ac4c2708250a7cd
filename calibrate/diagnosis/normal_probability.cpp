// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/normal_probability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/SpecialFunctions>

namespace tilth {
namespace {

// Ten-point Gauss-Legendre rule on [-1, 1], positive nodes (Abramowitz & Stegun 1964, table 25.4).
constexpr std::array<double, 5> nodes = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                         0.8650633666889845, 0.9739065285171717};
constexpr std::array<double, 5> weights = {0.2955242247147529, 0.2692667193099963,
                                           0.2190863625159820, 0.1494513491505806,
                                           0.0666713443086881};
constexpr double least_probability = 1e-16;

double plackett_density(double a, double b, double angle) {
  const double sine = std::sin(angle);
  return std::exp(-(a * a + b * b - 2.0 * a * b * sine) / (2.0 * (1.0 - sine * sine)));
}

double panel_integral(double a, double b, double from, double to) {
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    sum += weights[i] * (plackett_density(a, b, middle - half * nodes[i]) +
                         plackett_density(a, b, middle + half * nodes[i]));
  return half * sum;
}

}  // namespace

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double log_normal_cdf(double x) {
  if (x > -30.0) return std::log(normal_cdf(x));
  return -0.5 * x * x - std::log(-x * std::sqrt(2.0 * std::numbers::pi)) - 1.0 / (x * x);
}

double normal_quantile(double probability) { return Eigen::numext::ndtri(probability); }

double chi_square_tail(double x, double freedom) {
  return freedom > 0.0 ? Eigen::numext::igammac(0.5 * freedom, 0.5 * std::max(0.0, x)) : 1.0;
}

double f_tail(double f, double freedom_1, double freedom_2) {
  if (!(freedom_1 > 0.0)) return 1.0;
  return Eigen::numext::betainc(0.5 * freedom_2, 0.5 * freedom_1,
                                freedom_2 / (freedom_2 + freedom_1 * std::max(0.0, f)));
}

double bivariate_normal_cdf(double a, double b, double rho) {
  const double end = std::asin(rho);
  const int num_panels = std::abs(rho) < 0.8 ? 1 : std::abs(rho) < 0.98 ? 4 : 16;
  double integral = 0.0;
  for (int i = 0; i < num_panels; ++i)
    integral += panel_integral(a, b, end * i / num_panels, end * (i + 1) / num_panels);
  const double value = normal_cdf(a) * normal_cdf(b) + integral / (2.0 * std::numbers::pi);
  return std::clamp(value, least_probability, 1.0);
}

double standard_normal(std::mt19937_64& rng) {
  return normal_quantile((static_cast<double>(rng() >> 11) + 0.5) * 0x1p-53);
}

}  // namespace tilth
