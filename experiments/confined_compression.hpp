// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Confined compression (oedometer) of a bonded disc with one or two unload-reload loops.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct ConfinedCompressionConfig {
  double ring_radius_m = 0.030;
  double ring_height_m = 0.036;
  int num_particles = 1500;
  double porosity = 0.40;
  double size_spread = 0.25;
  double bond_gap_over_radius = 0.1;
  double load_from_stress_Pa = 25e3;   ///< the loading secant begins here
  double load_to_stress_Pa = 100e3;    ///< ... ends here, and unloading begins
  double unload_to_stress_Pa = 25e3;   ///< ... and ends here, and reloading begins
  /// Above load_to: reloading goes on to this stress, and a second loop to unload_to and back
  /// follows; else no such loop.
  double second_load_to_stress_Pa = 0.0;
  double platen_speed_over_wave_speed = 3e-4;  ///< closing speed of both platens together
  double max_axial_strain = 0.4;
  double platen_friction_scale = 1.0;  ///< times wall_friction: 0 greases the platens, not the ring
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(ConfinedCompressionConfig& config);

/// The packing the test begins with.
PackingSpec packing_spec(const ConfinedCompressionConfig& config);

/// One result per member.
///
/// A greased rigid ring; both platens close, open and close again at constant speed. Stress = mean of
/// both platen forces over the ring's area, strain = closing over initial height, both positive in
/// compression. Curve `stress_strain`: axial_strain, axial_stress_Pa, radial_stress_Pa, bonds_broken.
/// Features: constrained_modulus_Pa (secant of first loading from load_from to load_to),
/// unload_modulus_Pa (secant of unloading from load_to to unload_to), reload_modulus_Pa,
/// compression_strain (at load_to), radial_stress_ratio (at load_to); with a second loop
/// second_unload_modulus_Pa and second_reload_modulus_Pa (secants turn to turn).
/// A member that reaches max_axial_strain first is `not_settled`.
std::vector<ExperimentResult> run_confined_compression(std::span<const SoilMaterial> members,
                                                       const ConfinedCompressionConfig& config,
                                                       PackingStore& packings,
                                                       const RunOptions& options = {});

}  // namespace tilth
