// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Random packings of spheres in a cylinder or a box, from porosity, size distribution and seed.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "dem_core/model.hpp"

namespace tilth {

enum class ContainerShape { cylinder, box };

struct PackingSpec {
  ContainerShape shape = ContainerShape::cylinder;
  double radius_m = 0.025;            ///< cylinder; its axis is z, its base at z = 0
  Vec3 size_m = Vec3(0.1, 0.1, 0.1);  ///< box from the origin; a cylinder uses size_m.z() as height
  int num_particles = 500;
  double porosity = 0.40;     ///< voids over container volume; reached exactly, in (0.3, 0.9)
  double size_spread = 0.25;  ///< radii uniform in mean x [1 - s, 1 + s], s in [0, 0.6]
  std::uint64_t seed = 1;
};

struct Packing {
  std::vector<double> radius_m;
  std::vector<Vec3> position_m;  ///< ordered in space, so that neighbours are near in memory
  double mean_radius_m = 0.0;
  double largest_overlap = 0.0;  ///< over the smaller radius of the pair, after relaxation
};

/// Everything wrong with a specification, one sentence each.
std::vector<std::string> problems(const PackingSpec& spec);

double container_volume_m3(const PackingSpec& spec);

/// Spheres of the final total volume are placed at random at 45 % of their size, grown to full size
/// while frictionless and strongly damped, then relaxed until the mean overlap stops falling.
/// Equal specifications give equal bits.
/// @cost about 4000 steps
Packing make_packing(const PackingSpec& spec);

/// The same last stage for grains that are already there: relaxed in the container of `spec`, whose
/// walls push in what sticks out, and put in spatial order. Only shape and size of `spec` count.
Packing relaxed_packing(const PackingSpec& spec, const std::vector<double>& radius_m,
                        const std::vector<Vec3>& position_m);

/// The packing with rigid tools in it: grains whose centre lies in a tool (as deep as its max_depth_m)
/// or nearer to it than a fifth of their radius are left out; the others, frictionless, are pushed
/// aside by the tools until the overlaps are gone or stop falling.
Packing packing_around(const PackingSpec& spec, const Packing& packing,
                       const std::vector<Tool>& tools);

/// Uniform in [0, 1) with 53 bits; the same everywhere, unlike the library's distributions.
double uniform01(std::mt19937_64& rng);

/// Order of the points along cells of the given width: z, then y, then x.
std::vector<int> spatial_order(const std::vector<Vec3>& position_m, double cell_m);

}  // namespace tilth
