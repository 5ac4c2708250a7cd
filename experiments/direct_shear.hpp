// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Direct shear of a bonded block in a split box at several constant normal stresses.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct DirectShearConfig {
  double box_length_m = 0.060;  ///< along shear and across
  double box_height_m = 0.036;  ///< both halves together
  int num_particles = 1500;
  double porosity = 0.40;
  double size_spread = 0.25;
  double bond_gap_over_radius = 0.1;
  std::vector<double> normal_stress_Pa = {10e3, 20e3, 40e3};
  double shear_speed_over_wave_speed = 3e-4;  ///< of the upper half, over sqrt((E_c + E_b) / rho)
  double max_shear_strain = 0.10;             ///< displacement over box length
  /// Not 0: the block is cut from a larger packing turned by this angle about y (across the shear
  /// plane's direction of motion); see cut_block().
  double cut_angle_rad = 0.0;
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(DirectShearConfig& config);

/// One result per member; every member is sheared once at each normal stress.
///
/// The top plate holds the normal stress by servo; after consolidation the upper half moves along x.
/// Shear stress = half the difference of the x forces on both halves over the initial area; walls
/// are greased. Curves `shear_<Pa>`: shear_displacement_m, shear_stress_Pa, normal_stress_Pa,
/// vertical_displacement_m (dilation positive), bonds_broken.
/// Features per normal stress p: peak_shear_stress_Pa@p, residual_shear_stress_Pa@p (mean over the last
/// quarter of the displacement), displacement_at_peak_m@p. From the straight line through the peaks:
/// cohesion_Pa, friction_angle_rad; through the residuals: residual_cohesion_Pa,
/// residual_friction_angle_rad (needs two normal stresses).
std::vector<ExperimentResult> run_direct_shear(std::span<const SoilMaterial> members,
                                               const DirectShearConfig& config,
                                               PackingStore& packings,
                                               const RunOptions& options = {});

}  // namespace tilth
