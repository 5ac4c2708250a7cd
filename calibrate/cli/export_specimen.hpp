// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The specimens that decks carry, with our own curve of each.
#pragma once

#include <cstdint>
#include <vector>

#include "calibrate/cli/export_source.hpp"
#include "dem_core/packing_store.hpp"
#include "dem_core/state.hpp"
#include "experiments/result.hpp"

namespace tilth {

/// Spheres between two platens at z = 0 and z = height_m, and how they are compressed.
struct ExportSpecimen {
  std::vector<double> radius_m;
  std::vector<Vec3> position_m;
  std::vector<BondGeometry> bonds;  ///< empty in a confined compression
  double mean_radius_m = 0.0;
  double radius_factor = 1.0;  ///< radii of our packing times this
  double container_radius_m = 0.0;
  double height_m = 0.0;
  double bond_gap_m = 0.0;            ///< pairs with a smaller gap are bonded
  double platen_speed_m_per_s = 0.0;  ///< closing speed
  double dt_s = 0.0;
  double final_strain = 0.0;  ///< where our own run ended
  std::string packing;        ///< one sentence
  Curve reference;            ///< ours: axial_strain, axial_stress_Pa, ...
};

inline constexpr int export_interval_steps = 20;   ///< steps of which curves give the mean
inline constexpr double export_restitution = 0.3;  ///< e where dashpots stand for local damping

/// Unconfined compression as `calibrate simulate --experiment unconfined_compression` runs it.
/// @throws ConfigError if our own run of it does not end
ExportSpecimen bonded_specimen(const SoilMaterial& material, int num_particles, std::uint64_t seed,
                               PackingStore& packings);

/// Confined compression of the unbonded spheres of our oedometer packing in a cylinder, for codes
/// without breakable bonds and reference distances. All radii are multiplied by the largest factor
/// that leaves no overlap; the bottom stays, the top moves; dashpots of e = export_restitution.
/// The run ends at load_to_stress_Pa of the oedometer, at the latest at its max_axial_strain.
ExportSpecimen loose_specimen(const SoilMaterial& material, int num_particles, std::uint64_t seed,
                              PackingStore& packings);

/// Model of the spheres of a specimen without bonds and references: what loose_specimen() runs.
/// Walls: bottom, top and, if container_radius_m > 0, the cylinder.
Model loose_model(const ExportSpecimen& specimen, const SoilMaterial& material);

/// Drives the top at platen_speed_m_per_s until its stress or strain is reached; interval means.
Curve compress(const Model& model, const ExportSpecimen& specimen, double end_stress_Pa,
               double end_strain);

/// Lines for the head of a deck: about_lines(), all values, the specimen and how to repeat it.
std::vector<std::string> deck_lines(const ExportSource& source, const ExportSpecimen& specimen);

/// x_m,y_m,z_m,radius_m; and first,second of the bonds (from 0).
std::string spheres_csv(const ExportSpecimen& specimen);
std::string bonds_csv(const ExportSpecimen& specimen);

}  // namespace tilth
