// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Cutting a batch of members into packs of lanes.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "dem_core/packing_store.hpp"
#include "experiments/material.hpp"
#include "experiments/result.hpp"

namespace tilth {

/// Calls body(k) once for every k in [0, n), in any order and on any thread.
using ForEach = std::function<void(std::size_t n, const std::function<void(std::size_t)>& body)>;

/// How a batch is run; nothing here changes a result.
struct RunOptions {
  int max_lanes = 0;                          ///< 1, 4 or 8; 0 takes what the processor offers
  const std::atomic<bool>* stop = nullptr;    ///< set to end early: results become `stopped`
  ForEach for_each;                           ///< runs packs side by side; empty: one by one
};

/// Lane counts that cover n members on a machine of `widest` lanes: full packs of the widest, then
/// the narrowest that holds the rest (a half-empty pack still costs less than single lanes).
std::vector<int> pack_widths(int n, int widest);

/// Runs one pack; task_of_lane has 1, 4 or 8 entries, the result one per lane.
using PackRunner =
    std::function<std::vector<ExperimentResult>(std::span<const std::size_t> task_of_lane)>;

/// Cuts tasks into packs, fills spare lanes with the pack's first task, runs the packs, and gives the results in the tasks' order. Lanes of a pack share grain masses, so only
/// tasks of one density go together; that, and nothing else, decides the packs.
std::vector<ExperimentResult> run_in_packs(std::span<const double> density_of_task,
                                           const RunOptions& options, const PackRunner& run);

/// Density of every member.
std::vector<double> densities_kg_per_m3(std::span<const SoilMaterial> members);

/// members[task] for every lane.
std::vector<SoilMaterial> pick(std::span<const SoilMaterial> members,
                               std::span<const std::size_t> task_of_lane);

}  // namespace tilth
