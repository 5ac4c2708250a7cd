// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A sweep to look at: a ParaView time series, and pictures of bed, tool and tracers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/vtk_files.hpp"
#include "experiments/sweep_tillage.hpp"

namespace tilth {

/// Files particles_*.vtp (radius_m, displacement_m, bonds_left), tool_*.vtp and tracers_*.vtp (depth_m,
/// lateral_m, displacement_m) of one run, and a .pvd of each that opens them as a time series.
class SweepVtk {
 public:
  explicit SweepVtk(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Writes one step. @throws std::runtime_error with the path
  void add(const SweepFrame& frame);

 private:
  void write(const std::string& what, double time_s, const std::string& text,
             std::vector<VtkStep>& steps) const;
  std::filesystem::path folder_;
  std::vector<VtkStep> particles_, tool_, tracers_;
};

/// A bed at one moment, kept after the run.
struct BedView {
  std::vector<Vec3> position_m = {};
  std::vector<Vec3> displacement_m = {};
  std::vector<double> radius_m = {};
  Mesh tool = {};                    ///< where it is
  std::vector<Vec3> tracer_m = {};   ///< where they are: their site and what their aggregates moved
  std::vector<double> tracer_depth_m = {};
  double surface_m = 0.0;
};

BedView view_of(const SweepFrame& frame);

/// Side view of the aggregates within a diameter of the tool's path, before, when the tool stops, and at
/// rest, with tool and tracers; below it the cross-section of the surface before and after.
/// @return empty, or why there is no picture
std::string draw_bed(const std::string& title, const BedView& before, const BedView& stopped,
                     const BedView& after, const std::filesystem::path& svg);

/// Draught, vertical and side force over the travel, and the steady window.
std::string draw_sweep_forces(const std::string& title, const ExperimentResult& result,
                              const std::filesystem::path& svg);

/// Height of the surface across the travel before and after, and the mean forward displacement of tracers.
std::string draw_sweep_section(const std::string& title, const ExperimentResult& result,
                               const std::filesystem::path& svg);

}  // namespace tilth
