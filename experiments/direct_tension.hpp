// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Direct tension: a bonded cylinder glued to two end plates and pulled apart.
#pragma once

#include <span>

#include "experiments/batch.hpp"

namespace tilth {

struct DirectTensionConfig {
  double specimen_radius_m = 0.025;
  double specimen_height_m = 0.05;
  int num_particles = 1000;
  double porosity = 0.40;
  double size_spread = 0.25;
  double bond_gap_over_radius = 0.1;  ///< of bonds, and of the glue at the plates
  /// Opening speed of the plates over sqrt((E_c + E_b) / rho); each plate moves at half of it.
  double pull_speed_over_wave_speed = 5e-5;
  double max_axial_strain = 0.05;
  double stop_at_peak_share = 0.5;    ///< ends when the stress has fallen to this share of its peak
  std::uint64_t packing_seed = 1;
};

std::vector<Field> fields(DirectTensionConfig& config);

/// The packing the test begins with.
PackingSpec packing_spec(const DirectTensionConfig& config);

/// One result per member.
///
/// Grains that touch a plate, or nearly, are glued to it by their own contact springs, which neither
/// slip nor break, so that the specimen parts inside. Stress = mean of both plate forces over the
/// initial area, strain = opening over initial height, both TENSION POSITIVE (this test alone).
/// Curve `stress_strain`: axial_strain, tensile_stress_Pa, bonds_broken.
/// Features: tensile_strength_Pa (largest stress), strain_at_peak, tensile_modulus_Pa (secant from the
/// origin to half the strength), bonds_broken_at_peak (share of all bonds).
/// A member that carries no tension at all is `not_settled`.
std::vector<ExperimentResult> run_direct_tension(std::span<const SoilMaterial> members,
                                                 const DirectTensionConfig& config,
                                                 PackingStore& packings,
                                                 const RunOptions& options = {});

}  // namespace tilth
