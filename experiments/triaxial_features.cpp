// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/triaxial_features.hpp"

#include <cmath>

#include "experiments/curve_features.hpp"

namespace tilth {
namespace {

enum Column : std::size_t { axial_strain, volumetric_strain, axial_stress, radial_stress };

constexpr double modulus_strain = 0.005;
constexpr double peak_half_window = 0.005;
constexpr double slope_half_window = 0.01;
constexpr double end_window = 0.02;
constexpr double least_strain = 0.04;
constexpr std::size_t least_rows = 10;

double deviator_Pa(const std::vector<double>& row) { return row[axial_stress] - row[radial_stress]; }

double stress_ratio(const std::vector<double>& row) {
  return 3 * deviator_Pa(row) / (row[axial_stress] + 2 * row[radial_stress]);
}

double deviator_at(const Curve& curve, double strain) {
  for (std::size_t k = 1; k < curve.rows.size(); ++k) {
    const std::vector<double>& a = curve.rows[k - 1];
    const std::vector<double>& b = curve.rows[k];
    if (b[axial_strain] < strain) continue;
    const double share = (strain - a[axial_strain]) / (b[axial_strain] - a[axial_strain]);
    return deviator_Pa(a) + share * (deviator_Pa(b) - deviator_Pa(a));
  }
  return deviator_Pa(curve.rows.back());
}

/// Rows whose strain is within half_window of that of row k: [first, last).
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
};

Window window_of(const Curve& curve, std::size_t k, double half_window) {
  const double middle = curve.rows[k][axial_strain];
  // 1e-9: rows on the edge belong to it, whatever their rounding
  const auto within = [&](std::size_t j) {
    return std::abs(curve.rows[j][axial_strain] - middle) <= half_window + 1e-9;
  };
  Window w{k, k + 1};
  while (w.first > 0 && within(w.first - 1)) --w.first;
  while (w.last < curve.rows.size() && within(w.last)) ++w.last;
  return w;
}

double mean_ratio(const Curve& curve, Window w) {
  double sum = 0.0;
  for (std::size_t j = w.first; j < w.last; ++j) sum += stress_ratio(curve.rows[j]);
  return sum / static_cast<double>(w.last - w.first);
}

double volumetric_slope(const Curve& curve, Window w) {
  std::vector<double> x, y;
  for (std::size_t j = w.first; j < w.last; ++j) {
    x.push_back(curve.rows[j][axial_strain]);
    y.push_back(curve.rows[j][volumetric_strain]);
  }
  return fit_line(x, y).slope;
}

}  // namespace

std::vector<Feature> triaxial_features(const Curve& curve) {
  const std::size_t n = curve.rows.size();
  if (n < least_rows || curve.rows.back()[axial_strain] < least_strain) return {};
  const double last_strain = curve.rows.back()[axial_strain];
  double peak = stress_ratio(curve.rows.front());
  double strain_at_peak = 0.0;
  double dilation = -1e300;
  std::size_t end = n;
  for (std::size_t k = 0; k < n; ++k) {
    const double ratio = mean_ratio(curve, window_of(curve, k, peak_half_window));
    if (ratio > peak) {
      peak = ratio;
      strain_at_peak = curve.rows[k][axial_strain];
    }
    const Window w = window_of(curve, k, slope_half_window);
    const double strain = curve.rows[k][axial_strain];
    const bool whole = strain >= slope_half_window && strain <= last_strain - slope_half_window;
    if (whole && w.last - w.first > 2) dilation = std::max(dilation, -volumetric_slope(curve, w));
    if (end == n && strain >= last_strain - end_window - 1e-9) end = k;
  }
  return {{"initial_modulus_Pa",
           (deviator_at(curve, modulus_strain) - deviator_Pa(curve.rows.front())) / modulus_strain},
          {"peak_stress_ratio", peak},
          {"strain_at_peak", strain_at_peak},
          {"end_stress_ratio", mean_ratio(curve, {end, n})},
          {"dilation_rate", dilation},
          {"final_volumetric_strain", curve.rows.back()[volumetric_strain]}};
}

}  // namespace tilth
