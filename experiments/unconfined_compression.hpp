// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Unconfined compression of a bonded cylinder between greased platens.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

/// What a technician writes on the sheet, and what the model needs beside it.
struct UnconfinedCompressionConfig {
  double specimen_radius_m = 0.025;
  double specimen_height_m = 0.10;
  int num_particles = 1500;
  double porosity = 0.40;             ///< of the packing of aggregates
  double size_spread = 0.25;
  double bond_gap_over_radius = 0.1;
  /// Closing speed of the platens over sqrt((E_c + E_b) / rho); each platen moves at half of it.
  double platen_speed_over_wave_speed = 2e-4;
  double max_axial_strain = 0.15;
  double stop_at_peak_share = 0.7;    ///< ends when the stress has fallen to this share of its peak
  /// > 1: a second run of the same specimen with platens this many times as fast; 1: no such run.
  double fast_rate_ratio = 1.0;
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(UnconfinedCompressionConfig& config);

/// The packing the test begins with.
PackingSpec packing_spec(const UnconfinedCompressionConfig& config);

/// One result per member.
///
/// Stress = mean of both platen forces over the initial area, compression positive; strain = closing
/// over initial height. Curve `stress_strain`: axial_strain, axial_stress_Pa, bonds_broken.
/// Features: peak_stress_Pa (largest stress up to max_axial_strain), strain_at_peak,
/// secant_modulus_Pa (from the origin to half the peak), bonds_broken_at_peak (share of all bonds);
/// with fast_rate_ratio > 1 also the curve `stress_strain_fast` and the feature fast_peak_ratio
/// = peak of the fast run / peak of the slow one. All other numbers are those of the slow run.
std::vector<ExperimentResult> run_unconfined_compression(std::span<const SoilMaterial> members,
                                                         const UnconfinedCompressionConfig& config,
                                                         PackingStore& packings,
                                                         const RunOptions& options = {});

}  // namespace tilth
