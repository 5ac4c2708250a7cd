// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Interface shear: a block of soil in a box, pressed on a steel plate that slides under it.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct InterfaceShearConfig {
  double box_length_m = 0.060;  ///< along sliding and across
  double box_height_m = 0.024;
  int num_particles = 1000;
  double porosity = 0.40;
  double size_spread = 0.25;
  double bond_gap_over_radius = 0.1;
  std::vector<double> normal_stress_Pa = {10e3, 20e3, 40e3};
  double slide_speed_over_wave_speed = 3e-4;  ///< of the steel plate, over sqrt((E_c + E_b) / rho)
  double max_slide_over_length = 0.05;        ///< travel of the plate over box length
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(InterfaceShearConfig& config);

/// One result per member; every member slides once at each normal stress.
///
/// The steel plate is the floor of the box and the only rough wall: it has the material's
/// `wall_friction`, box and top plate are greased. The top plate holds the normal stress by servo;
/// after consolidation the steel slides along x. Interface stress = force on the steel against its
/// motion over the area of the box, positive; normal stress = that on the steel.
/// Curves `slide_<Pa>`: slide_displacement_m, interface_stress_Pa, normal_stress_Pa,
/// vertical_displacement_m, bonds_broken.
/// Features per normal stress p: peak_interface_stress_Pa@p, residual_interface_stress_Pa@p (mean over
/// the last quarter of the travel), slide_at_peak_m@p. From the straight line through the residuals
/// over the normal stresses measured on the steel at the same time: adhesion_Pa,
/// interface_friction_angle_rad (needs two normal stresses).
std::vector<ExperimentResult> run_interface_shear(std::span<const SoilMaterial> members,
                                                  const InterfaceShearConfig& config,
                                                  PackingStore& packings,
                                                  const RunOptions& options = {});

}  // namespace tilth
