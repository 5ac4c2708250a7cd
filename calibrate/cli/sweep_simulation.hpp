// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate simulate` of a sweep: watched runs, their pictures and their ParaView series.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "calibrate/cli/test_runs.hpp"

namespace tilth {

struct SweepOutput {
  std::filesystem::path folder;  ///< of the run
  bool vtk = false;
  double vtk_interval_m = 0.05;  ///< of travel
};

/// One result per packing seed; packings run side by side on the context's threads. Writes
/// figures/sweep_tillage_seed<n>_{bed,forces,section}.svg and, where asked for, vtk/seed<n>/.
/// @param missing  receives why a picture is not there
std::vector<ExperimentResult> simulate_sweeps(const SweepTillageConfig& config,
                                              const SoilMaterial& material,
                                              std::span<const std::uint64_t> seeds,
                                              const RunContext& context, const SweepOutput& output,
                                              std::vector<std::string>& missing);

}  // namespace tilth
