// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/student_t.hpp"

#include <cmath>
#include <numbers>

namespace tilth {
namespace {

double probability_at_angle(double theta, int freedom) {
  const bool is_odd = freedom % 2 == 1;
  const double cosine = std::cos(theta);
  double term = is_odd ? cosine : 1.0;
  double sum = freedom == 1 ? 0.0 : term;
  for (int k = is_odd ? 3 : 2; k <= freedom - 2; k += 2) {
    term *= cosine * cosine * (k - 1.0) / k;
    sum += term;
  }
  if (!is_odd) return std::sin(theta) * sum;
  return 2.0 / std::numbers::pi * (theta + std::sin(theta) * sum);
}

}  // namespace

double student_t_central_probability(double t, int freedom) {
  return probability_at_angle(std::atan(t / std::sqrt(freedom)), freedom);
}

double student_t_half_width(double probability, int freedom) {
  double low = 0.0;
  double high = 0.5 * std::numbers::pi;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    (probability_at_angle(middle, freedom) < probability ? low : high) = middle;
  }
  return std::tan(low) * std::sqrt(freedom);
}

}  // namespace tilth
