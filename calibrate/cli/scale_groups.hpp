// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Dimensionless groups of a sweep in a bed, and which of them survive when only the particles grow.
#pragma once

#include <string>
#include <vector>

#include "experiments/material.hpp"
#include "experiments/sweep_tillage.hpp"

namespace tilth {

struct SimilarityGroup {
  std::string kind;     ///< "geometric", "kinematic" or "dynamic"
  std::string name;
  std::string formula;
  double finest = 0.0, coarsest = 0.0;
  bool kept = false;    ///< equal to rounding
};

/// Groups at the finest and at the coarsest radius, everything else equal: r mean radius, B tool width, h tool
/// depth, v speed, rho bulk density, g gravity, E_c and E_b moduli, sigma_t and c bond strengths.
///
/// Since contacts and bonds are given as moduli and strengths (forces grow as r^2, stiffness as r), stresses,
/// strains and speeds do not know r: that is Feng & Owen's scale-invariant law. What cannot be kept while the tool
/// stays are the lengths of one grain: r over B and h, the inertial number, and the work to fracture per area, which
/// is proportional to r.
/// @source Feng, Han, Owen & Loughran, Engineering Computations 26 (2009) 599-609; Feng & Owen, Computational
///         Particle Mechanics 1 (2014) 159-168; the choice of groups is our own
std::vector<SimilarityGroup> similarity_groups(const SweepTillageConfig& config, const SoilMaterial& material,
                                               double finest_m, double coarsest_m);

}  // namespace tilth
