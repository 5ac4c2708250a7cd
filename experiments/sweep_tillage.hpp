// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A sweep drawn through a bin of bonded aggregates: forces, moved tracers, furrow.
#pragma once

#include <functional>
#include <span>

#include "experiments/batch.hpp"
#include "experiments/specimen.hpp"
#include "experiments/sweep_shape.hpp"
#include "experiments/tracers.hpp"

namespace tilth {

struct SweepTillageConfig {
  double bin_width_m = 0.7;
  double bin_length_m = 1.2;
  double bed_depth_m = 0.22;          ///< before it settles; a floor nearer than 0.1 m below the edge is felt
  double particle_radius_m = 0.018;   ///< mean; the number of aggregates follows
  double size_spread = 0.25;
  double porosity = 0.40;             ///< between the spheres that stand for aggregates: a choice
  double bulk_density_kg_per_m3 = 1450;  ///< of the soil as it lies; sets the aggregates' density
  double bond_gap_over_radius = 0.1;  ///< below 0 nothing is bonded
  double gravity_m_per_s2 = 9.81;
  double restitution = 0.3;           ///< of aggregates; dashpots instead of local damping
  double tool_depth_m = 0.10;         ///< of the cutting edges below the mean settled surface
  double speed_m_per_s = 0.889;       ///< 3.2 km/h
  SweepShape sweep;
  double end_clearance_m = 0.15;      ///< from the nose to the end of the bin when the tool stops
  std::vector<double> tracer_depth_m = {0.02, 0.05, 0.08};
  std::vector<double> tracer_lateral_m = {-0.10, -0.05, 0.0, 0.05, 0.10};
  double tracer_spacing_m = 0.05;     ///< along the travel
  double tracer_size_m = 0.016;
  double disturbed_beyond_m = 0.01;   ///< soil moved further than this counts as disturbed
  std::uint64_t packing_seed = 1;
  /// A tool of other shape instead of `sweep`, travelling along +x, z up; no setting of this name.
  Mesh tool_mesh = {};
};

std::vector<Field> fields(SweepTillageConfig& config);

/// What the numbers contradict among themselves, beside their ranges: a particle too large for tool or
/// bin, a tool wider than the bin, tracers outside it, a bin too short, an impossible density or shape.
std::vector<std::string> problems(const SweepTillageConfig& config);

/// Aggregates that fill the bin: N = V (1 - porosity) / (4/3 pi r^3 (1 + spread^2)).
int num_aggregates(const SweepTillageConfig& config);

/// Density of one aggregate that gives the bed its bulk density: bulk / (1 - porosity).
double aggregate_density_kg_per_m3(const SweepTillageConfig& config);

/// The packing the bed is made of.
PackingSpec packing_spec(const SweepTillageConfig& config);

/// The tool in its own frame: foremost point at x = 0, lowest at z = 0.
Mesh tool_mesh(const SweepTillageConfig& config);

/// One result per member. @pre problems(config) is empty
///
/// The packing, bonded where it touches and glued to the floor, settles under gravity; the tool, from
/// outside the bed, is drawn along +x at constant depth and speed until it nears the end; the bed comes
/// to rest. Walls are the member's; the member's own density and, while the tool moves, its local damping
/// are not used. Forces are those of the soil on the tool: draught positive against the travel, vertical
/// positive up, side positive to the left (+y).
/// Curves: `sweep_forces` (travel_m of the nose from the front wall, draught_N, vertical_N, side_N,
/// contacts, contact_density_per_m2, forward_flow_m_per_s and outward_flow_m_per_s of the aggregates above the
/// wings); `tracers` (tracer, initial_depth_m, initial_lateral_m, initial_x_m,
/// forward_m, lateral_m, vertical_m); `tracer_means` (initial_depth_m, initial_lateral_m, tracers, mean
/// and sd of each displacement); `surface_before`, `surface_after`, `furrow` (lateral_m, height_m).
/// Features, means over the steady window with its standard error from the autocorrelation:
/// draught_N, draught_error_N, vertical_force_N, vertical_force_error_N, side_force_N,
/// side_force_error_N, steady_begin_m, steady_end_m, tool_contacts, contact_density_per_m2, flow_angle_rad (see
/// sweep_flow.hpp; not for a tool of other shape),
/// furrow_area_m2, ridge_area_m2, disturbed_area_m2 (cross-section of soil that moved); for every depth and
/// offset forward_displacement_m@<depth>m_<offset>m, lateral_..., vertical_...; for every depth the mean
/// over the offsets, forward_displacement_m@<depth>m and vertical_displacement_m@<depth>m.
std::vector<ExperimentResult> run_sweep_tillage(std::span<const SoilMaterial> members,
                                                const SweepTillageConfig& config,
                                                PackingStore& packings,
                                                const RunOptions& options = {});

enum class SweepMoment { settled, travelling, stopped, at_rest };

/// What an observer may look at; valid during the call only.
struct SweepFrame {
  SweepMoment moment = SweepMoment::settled;
  double time_s = 0.0;
  double travel_m = 0.0;               ///< of the nose from the front wall
  double surface_m = 0.0;              ///< mean settled level
  const Specimen& specimen;            ///< one lane
  const std::vector<Vec3>& settled_m;  ///< where the aggregates lay before the tool came
  std::span<const Tracer> tracers;
};

struct SweepObserver {
  double interval_m = 0.05;  ///< of travel between two frames
  std::function<void(const SweepFrame&)> frame;
};

/// The test of one member, watched: the observer gets the settled bed, frames of the travel, the bed when
/// the tool has stopped and at rest. The result has the bits of run_sweep_tillage().
ExperimentResult watch_sweep_tillage(const SoilMaterial& member, const SweepTillageConfig& config,
                                     PackingStore& packings, const SweepObserver& observer,
                                     const RunOptions& options = {});

}  // namespace tilth
