// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Strengths that differ from bond to bond: heterogeneity, bedding, a pan.
#pragma once

#include <cstdint>
#include <span>

#include "dem_core/packing.hpp"
#include "experiments/material.hpp"

namespace tilth {

/// Where bonds lie in the ground.
struct BondPlace {
  double surface_m = -1e300;           ///< z of the bed's surface; specimens from the topsoil have none
  Vec3 bedding = Vec3::UnitZ();  ///< normal of the layers
};

/// Factors [bond][lane] on the strengths of the bonds of a model, or none where no material asks for them:
///
///   factor = W(u; F) (1 + a (3 (n . bedding)^2 - 1) / 2) (1 + kappa [depth > z_p])
///
/// u is the bond's own number in (0, 1), fixed by packing and pair of grains (bond_uniform); n joins the two
/// grains; depth is that of the bond's middle below the surface. A factor below 0.01 is raised to it.
AlignedDoubles bond_strengths(const Model& model, const Packing& packing,
                              std::span<const SoilMaterial> materials, const BondPlace& place);

/// Quantile of the Weibull distribution of mean 1 and coefficient of variation `cv`:
///   W(u) = (-ln(1 - u))^(1/k) / Gamma(1 + 1/k),  cv^2 = Gamma(1 + 2/k) / Gamma(1 + 1/k)^2 - 1;
/// 1 for cv = 0, the limit of both. @source Weibull 1951, J. Appl. Mech. 18, 293-297
double weibull_quantile(double u, double cv);

/// Shape k of that distribution. @pre cv > 0
double weibull_shape(double cv);

/// A number that names a packing: equal radii, equal number.
std::uint64_t packing_number(const Packing& packing);

/// In (0, 1), the same for a pair of grains of a packing always.
double bond_uniform(std::uint64_t packing_number, std::int32_t i, std::int32_t j);

}  // namespace tilth
