// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Scenes of the core's tests: a handful of spheres, bonds and walls, written as a paragraph.
#pragma once

#include <string>
#include <vector>

#include "dem_core/diagnostics.hpp"
#include "dem_core/step.hpp"

namespace tilth::testing {

/// A model under construction, then its run. One lane of frictionless elastic contacts of stiffness
/// 1e4 N/m, no bonds, no gravity, unless the test says otherwise.
struct Scene {
  Model model;
  std::vector<Vec3> start_m;
  State state;
  Workspace workspace;

  Scene();
  LaneLaw& law(int lane = 0) { return model.lanes[static_cast<std::size_t>(lane)]; }
  /// Returns the sphere's number.
  int sphere(const Vec3& position_m, double radius_m = 1.0, double mass_kg = 1.0);
  /// A bond without stress at the start whose stiffness numbers are those of BondLaw. i < j,
  /// sorted.
  BondGeometry& bond(int i, int j);
  /// Returns the wall's number.
  int plane(const Vec3& normal, const Vec3& point_m = Vec3::Zero());
  /// The same laws in every lane.
  void set_num_lanes(int num_lanes);
  /// Fails the test if the model has problems; then makes the state.
  void begin();
  void run(int num_steps);
  Energy energy_now(int lane = 0) const { return energy(model, state, workspace, lane); }
};

/// Mass of a body that nothing in a test can move.
inline constexpr double fixed_mass_kg = 1e15;

/// num_points uniform in the box [0, size]^3, distances of at least min_distance_m, from a seed.
std::vector<Vec3> scattered_points(int num_points, double size_m, double min_distance_m,
                                   unsigned seed);

/// A compact cluster: num_grains touching or overlapping grains of radius about 1 m and mass about
/// 1 kg, every pair within reach_m bonded at its distance.
void add_bonded_cluster(Scene& scene, const Vec3& centre_m, int num_grains, double reach_m,
                        unsigned seed);

/// Rows of a table with '#' comments and one line of column names.
std::vector<std::vector<double>> read_table(const std::string& file);

/// The reference bonded cylinder (tests/reference/bonded_cylinder/README.md), all lanes alike.
/// Wall 0 is the bottom plate, wall 1 the top plate, at rest.
struct BondedCylinder {
  static constexpr double height_m = 37.252929;
  static constexpr double radius_m = 10.243342;
  static constexpr double strain_rate_per_s = 3e-3;
};
Scene bonded_cylinder(int num_lanes);

/// Mean of the two plate forces over the cross-section.
double plate_stress_Pa(const State& state, int lane = 0);

}  // namespace tilth::testing
