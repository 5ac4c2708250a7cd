// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Settings of sweep_tillage: names, ranges, contradictions.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem_core/mesh.hpp"
#include "experiments/sweep_stretch.hpp"
#include "experiments/sweep_tillage.hpp"

namespace tilth {
namespace {

/// Above this an aggregate would be heavier than any soil mineral in bulk.
constexpr double heaviest_aggregate_kg_per_m3 = 3500;

struct Extent {
  Vec3 low_m, high_m;
};

Extent extent_of(const Mesh& mesh) {
  Extent e{mesh.vertex_m.front(), mesh.vertex_m.front()};
  for (const Vec3& v : mesh.vertex_m) {
    e.low_m = e.low_m.cwiseMin(v);
    e.high_m = e.high_m.cwiseMax(v);
  }
  return e;
}

void check_sizes(const SweepTillageConfig& c, const Extent& tool, std::vector<std::string>& found) {
  const double tool_width_m = tool.high_m.y() - tool.low_m.y();
  const double reach_m = std::max(tool.high_m.y(), -tool.low_m.y());
  if (2 * reach_m > 0.9 * c.bin_width_m)
    found.push_back(
        fmt::format("the tool reaches {:.4g} m to the side: the bin, bin_width_m = {}, has "
                    "room for {:.4g} m",
                    reach_m, c.bin_width_m, 0.45 * c.bin_width_m));
  if (c.tool_depth_m >= c.bed_depth_m) {
    found.push_back(fmt::format("tool_depth_m = {}: must be below bed_depth_m = {}", c.tool_depth_m,
                                c.bed_depth_m));
    return;
  }
  const struct {
    double limit_m;
    const char* reason;
  } limits[] = {
      {tool_width_m / 6, "three diameters across the tool"},
      {0.5 * c.tool_depth_m, "one diameter between surface and cutting edge"},
      {0.5 * (c.bed_depth_m - c.tool_depth_m), "one diameter between cutting edge and floor"},
      {0.25 * (c.bin_width_m - 2 * reach_m), "one diameter between tool and side wall"}};
  const auto& least =
      *std::ranges::min_element(limits, {}, [](const auto& l) { return l.limit_m; });
  if (least.limit_m > 0 && c.particle_radius_m > least.limit_m)
    found.push_back(
        fmt::format("particle_radius_m = {}: too large for this tool and bin, the limit is "
                    "{:.4g} ({})",
                    c.particle_radius_m, least.limit_m, least.reason));
}

void check_bin(const SweepTillageConfig& c, std::vector<std::string>& found) {
  if (const double density = aggregate_density_kg_per_m3(c); density > heaviest_aggregate_kg_per_m3)
    found.push_back(
        fmt::format("bulk_density_kg_per_m3 = {} at porosity = {}: needs aggregates of "
                    "{:.0f} kg/m3, above {:.0f}: impossible for soil",
                    c.bulk_density_kg_per_m3, c.porosity, density, heaviest_aggregate_kg_per_m3));
  constexpr int most = 2'000'000;
  if (const int n = num_aggregates(c); n < 50 || n > most)
    found.push_back(fmt::format("particle_radius_m = {}: gives {} aggregates, must be 50 to {}",
                                c.particle_radius_m, n, most));
  const SweepStretch stretch(c);
  if (!(stretch.tracers_to_m > stretch.steady_from_m))
    found.push_back(
        fmt::format("bin_length_m = {}: too short for a steady stretch, needs more than "
                    "{:.4g} for this tool, depth and end_clearance_m",
                    c.bin_length_m, c.bin_length_m + stretch.steady_from_m - stretch.tracers_to_m));
}

void check_tracers(const SweepTillageConfig& c, std::vector<std::string>& found) {
  if (c.tracer_depth_m.empty() || c.tracer_lateral_m.empty())
    found.push_back("tracer_depth_m and tracer_lateral_m need one entry at least");
  for (const double d : c.tracer_depth_m)
    if (!(d <= c.bed_depth_m))
      found.push_back(
          fmt::format("tracer_depth_m = {}: the tracer is outside the bin, bed_depth_m = {}", d,
                      c.bed_depth_m));
  for (const double y : c.tracer_lateral_m)
    if (!(std::abs(y) <= 0.5 * c.bin_width_m))
      found.push_back(
          fmt::format("tracer_lateral_m = {}: the tracer is outside the bin, which reaches "
                      "from {} to {}",
                      y, -0.5 * c.bin_width_m, 0.5 * c.bin_width_m));
}

}  // namespace

std::vector<Field> fields(SweepTillageConfig& c) {
  return {{"bin_width_m", &c.bin_width_m, 0.02, 10},
          {"bin_length_m", &c.bin_length_m, 0.05, 50},
          {"bed_depth_m", &c.bed_depth_m, 0.01, 2},
          {"particle_radius_m", &c.particle_radius_m, 5e-4, 0.2},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"bulk_density_kg_per_m3", &c.bulk_density_kg_per_m3, 200, 2300},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, -1, 1},
          {"gravity_m_per_s2", &c.gravity_m_per_s2, 1e-3, 1000},
          {"restitution", &c.restitution, 0.05, 1},
          {"tool_depth_m", &c.tool_depth_m, 0.005, 1},
          {"speed_m_per_s", &c.speed_m_per_s, 1e-3, 20},
          {"tool_width_m", &c.sweep.width_m, 0.005, 5},
          {"sweep_angle_rad", &c.sweep.sweep_angle_rad, 0.1, 3.1},
          {"rake_angle_rad", &c.sweep.rake_angle_rad, 0.02, 1.5},
          {"wing_height_m", &c.sweep.wing_height_m, 1e-3, 1},
          {"tool_thickness_m", &c.sweep.thickness_m, 1e-4, 0.1},
          {"shank_width_m", &c.sweep.shank_width_m, 1e-3, 1},
          {"shank_length_m", &c.sweep.shank_length_m, 1e-3, 1},
          {"end_clearance_m", &c.end_clearance_m, 0.01, 10},
          {"tracer_depth_m", &c.tracer_depth_m, 0, 2},
          {"tracer_lateral_m", &c.tracer_lateral_m, -5, 5},
          {"tracer_spacing_m", &c.tracer_spacing_m, 1e-3, 10},
          {"tracer_size_m", &c.tracer_size_m, 1e-3, 0.2},
          {"disturbed_beyond_m", &c.disturbed_beyond_m, 1e-4, 1},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

std::vector<std::string> problems(const SweepTillageConfig& c) {
  SweepTillageConfig copy = c;
  // Sizes that are out of range make no sense together either.
  if (!range_problems(fields(copy)).empty()) return {};
  const bool own_tool = !c.tool_mesh.triangle.empty();
  std::vector<std::string> found = own_tool ? problems(c.tool_mesh) : problems(c.sweep);
  if (!found.empty()) return found;
  check_sizes(c, extent_of(tool_mesh(c)), found);
  check_bin(c, found);
  check_tracers(c, found);
  return found;
}

int num_aggregates(const SweepTillageConfig& c) {
  const double volume_m3 = c.bin_width_m * c.bin_length_m * c.bed_depth_m;
  const double r = c.particle_radius_m;
  // mean r^3 of radii uniform in r [1 - s, 1 + s] is r^3 (1 + s^2)
  const double mean_m3 =
      4.0 / 3 * std::numbers::pi * r * r * r * (1 + c.size_spread * c.size_spread);
  return static_cast<int>(std::min(std::round(volume_m3 * (1 - c.porosity) / mean_m3), 1e9));
}

double aggregate_density_kg_per_m3(const SweepTillageConfig& c) {
  return c.bulk_density_kg_per_m3 / (1 - c.porosity);
}

PackingSpec packing_spec(const SweepTillageConfig& c) {
  return {.shape = ContainerShape::box,
          .size_m = Vec3(c.bin_length_m, c.bin_width_m, c.bed_depth_m),
          .num_particles = num_aggregates(c),
          .porosity = c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

Mesh tool_mesh(const SweepTillageConfig& c) {
  // The shank ends where no thrown aggregate comes down on its top.
  if (c.tool_mesh.triangle.empty()) return sweep_mesh(c.sweep, c.tool_depth_m + 2 * c.bed_depth_m);
  Mesh mesh = c.tool_mesh;
  const Extent e = extent_of(mesh);
  for (Vec3& v : mesh.vertex_m) v -= Vec3(e.high_m.x(), 0, e.low_m.z());
  return mesh;
}

SweepStretch::SweepStretch(const SweepTillageConfig& c) {
  const Extent e = extent_of(tool_mesh(c));
  tool_length_m = e.high_m.x() - e.low_m.x();
  travel_to_m = c.bin_length_m - c.end_clearance_m;
  steady_from_m = tool_length_m + c.tool_depth_m;
  tracers_to_m = travel_to_m - tool_length_m - 0.5 * c.tool_depth_m;
}

}  // namespace tilth
