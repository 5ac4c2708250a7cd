// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Drained triaxial compression of a cube between six greased plates, cell pressure held by servo.
#pragma once

#include <optional>
#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct DrainedTriaxialConfig {
  double side_m = 0.100;  ///< of the cube; a cloud of unbonded grains is pressed together from here
  int num_particles = 1500;
  double size_spread = 0.25;
  std::vector<double> cell_pressure_Pa = {100e3};
  /// Empty: a packing of `porosity`, bonded, as in the other tests. Else one for each cell pressure, in
  /// [0, 1]: the specimen has no bonds and is prepared to this relative density on the own states of
  /// its grains (density_preparation.hpp).
  std::vector<double> relative_density = {};
  double porosity = 0.40;
  double bond_gap_over_radius = 0.1;
  /// Of shearing: I = strain rate x mean diameter x sqrt(grain density / cell pressure).
  double inertial_number = 1e-3;
  double max_axial_strain = 0.20;
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(DrainedTriaxialConfig& config);

/// Everything that makes a config unusable beyond the ranges of its fields.
std::vector<std::string> problems(const DrainedTriaxialConfig& config);

/// "100600" or "100600,0.509": what stands behind the @ of the features of one test of the series.
std::string triaxial_state_label(double cell_pressure_Pa, std::optional<double> relative_density);

/// One result per member; every member is tested at each cell pressure (and its relative density).
///
/// Stages: 1. isotropic consolidation to the cell pressure; an unbonded specimen is pressed together
/// from a cloud with the friction that gives its relative density and then gets its own; 2. base and
/// lid close at the rate of the inertial number while the four sides hold the cell pressure. Local
/// damping brakes grains that follow a moving plate: at 0.7 and an inertial number of 4e-3 the two
/// sides read 17 % apart, at 0.2 and 1e-3 by 2 %; the curves give the mean of both.
/// Curves `triaxial_<label>`: axial_strain, volumetric_strain, axial_stress_Pa, radial_stress_Pa.
/// Features per test: those of triaxial_features() with `@<label>`, initial_void_ratio@, and for
/// prepared specimens relative_density@ (reached), loosest_void_ratio@, densest_void_ratio@.
/// With two or more cell pressures, from the straight line q/2 against (axial + radial)/2 at the
/// peaks: friction_angle_rad = asin(slope), cohesion_Pa = intercept / cos(angle); and
/// stiffness_exponent, the slope of ln(initial modulus) against ln(cell pressure).
/// @source Mohr-Coulomb in s-t form, e.g. Wood, Soil Behaviour and Critical State Soil Mechanics
///         (Cambridge, 1990)
std::vector<ExperimentResult> run_drained_triaxial(std::span<const SoilMaterial> members,
                                                   const DrainedTriaxialConfig& config,
                                                   PackingStore& packings,
                                                   const RunOptions& options = {});

}  // namespace tilth
