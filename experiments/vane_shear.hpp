// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A cruciform vane turned in a bonded block under a surcharge.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct VaneShearConfig {
  double box_width_m = 0.080;  ///< square, so that the block cannot turn as a whole
  double box_height_m = 0.080;
  int num_particles = 2000;
  double porosity = 0.40;
  double size_spread = 0.25;
  double bond_gap_over_radius = 0.1;
  double vane_diameter_m = 0.036;
  double vane_height_m = 0.036;       ///< twice the diameter in the field; see the page of this test
  double blade_thickness_m = 0.002;
  double surcharge_stress_Pa = 5e3;   ///< of the top plate
  double tip_speed_over_wave_speed = 3e-4;  ///< of the blades' outer edge, over sqrt((E_c + E_b) / rho)
  double max_rotation_rad = 0.6;
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(VaneShearConfig& config);

/// The packing the vane is then placed in.
PackingSpec packing_spec(const VaneShearConfig& config);

/// One result per member.
///
/// The packing is made around the vane ("wished in place", without stress), bonded, consolidated under
/// the surcharge by the top plate's servo, and the vane turned about its axis at constant speed. The
/// vane is embedded at both ends. Walls are greased, no gravity.
/// Curve `torque`: rotation_rad, torque_N_m, vane_shear_stress_Pa, surcharge_Pa, bonds_broken; torque is
/// positive against the rotation. The stress assumes one strength on the cylinder and both its ends:
///   tau = T / (pi D^2 (H / 2 + D / 6))
/// Features: vane_strength_Pa (largest tau), residual_vane_strength_Pa (mean over the last quarter of
/// the rotation), rotation_at_peak_rad.
/// @source of the formula: integral of tau r over the surface, derived in docs/experiments/vane_shear.md
std::vector<ExperimentResult> run_vane_shear(std::span<const SoilMaterial> members,
                                             const VaneShearConfig& config, PackingStore& packings,
                                             const RunOptions& options = {});

/// Torque of a uniform shear stress of 1 Pa on a cylinder's mantle and both ends [m3].
double vane_constant_m3(double diameter_m, double height_m);

}  // namespace tilth
