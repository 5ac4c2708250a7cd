// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Radius classes: codes that know one stiffness per pair of types get a type per class of radii.
#pragma once

#include <span>
#include <vector>

#include "experiments/material.hpp"

namespace tilth {

/// Classes of equal width between the smallest and the largest radius.
struct RadiusClasses {
  std::vector<int> class_of;     ///< of each sphere, from 0
  std::vector<double> radius_m;  ///< mean radius of a class, its middle where it is empty
  double largest_error = 0.0;    ///< of k_n in any contact of two spheres, relative, upper bound
};

/// @param num_classes >= 1; equal radii give one class
RadiusClasses radius_classes(std::span<const double> radius_m, int num_classes);

/// Numbers of a contact between two classes, or a class and a wall.
struct ClassContact {
  double normal_stiffness_N_per_m =
      0.0;  ///< k_n = E_c pi min(R_a, R_b)^2 / (R_a + R_b); wall E_c pi R
  double shear_stiffness_N_per_m = 0.0;  ///< k_n / kappa
  double normal_damping_per_s = 0.0;  ///< gamma = 2 zeta sqrt(k_n / m_eff), times m_eff in the law
  double friction = 0.0;
};

ClassContact class_contact(const SoilMaterial& material, double radius_a_m, double radius_b_m,
                           double restitution);
ClassContact wall_contact(const SoilMaterial& material, double radius_m, double restitution);

}  // namespace tilth
