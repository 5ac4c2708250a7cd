// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/export_classes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tilth {
namespace {

constexpr double pi = std::numbers::pi;

double mass_kg(const SoilMaterial& m, double radius_m) {
  return 4.0 / 3.0 * pi * radius_m * radius_m * radius_m * m.density_kg_per_m3;
}

ClassContact contact(const SoilMaterial& m, double k_n, double effective_mass_kg,
                     double restitution, double friction) {
  return {k_n, k_n / m.contact_stiffness_ratio,
          damping_number(restitution) * std::sqrt(k_n / effective_mass_kg), friction};
}

}  // namespace

RadiusClasses radius_classes(std::span<const double> radius_m, int num_classes) {
  const auto [low, high] = std::ranges::minmax(radius_m);
  const int n = high > low ? num_classes : 1;
  const double width_m = (high - low) / n;
  RadiusClasses classes;
  std::vector<double> sum_m(static_cast<std::size_t>(n), 0.0);
  std::vector<int> count(static_cast<std::size_t>(n), 0);
  for (const double r : radius_m) {
    const int k = width_m > 0 ? std::min(n - 1, static_cast<int>((r - low) / width_m)) : 0;
    classes.class_of.push_back(k);
    sum_m[static_cast<std::size_t>(k)] += r;
    ++count[static_cast<std::size_t>(k)];
  }
  for (int k = 0; k < n; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    classes.radius_m.push_back(count[at] > 0 ? sum_m[at] / count[at] : low + (k + 0.5) * width_m);
  }
  // d ln k_n = (2 - w) d ln r_min - (1 - w) d ln r_max with w = r_min / (r_min + r_max), so that
  // radii off by at most e in relation give k_n off by at most (3 - 2 w) e.
  for (std::size_t i = 0; i < radius_m.size(); ++i) {
    const double mean_m = classes.radius_m[static_cast<std::size_t>(classes.class_of[i])];
    classes.largest_error = std::max(classes.largest_error, std::abs(mean_m / radius_m[i] - 1));
  }
  classes.largest_error *= 3 - 2 * low / (low + high);
  return classes;
}

ClassContact class_contact(const SoilMaterial& m, double ra_m, double rb_m, double restitution) {
  const double least_m = std::min(ra_m, rb_m);
  const double k_n = m.contact_modulus_Pa * pi * least_m * least_m / (ra_m + rb_m);
  const double ma_kg = mass_kg(m, ra_m);
  const double mb_kg = mass_kg(m, rb_m);
  return contact(m, k_n, ma_kg * mb_kg / (ma_kg + mb_kg), restitution, m.friction);
}

ClassContact wall_contact(const SoilMaterial& m, double radius_m, double restitution) {
  return contact(m, m.contact_modulus_Pa * pi * radius_m, mass_kg(m, radius_m), restitution,
                 m.wall_friction);
}

}  // namespace tilth
