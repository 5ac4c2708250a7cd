// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Cutting a batch of members into packs of lanes.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "dem_core/packing_store.hpp"
#include "dem_core/state.hpp"
#include "experiments/material.hpp"
#include "experiments/result.hpp"

namespace tilth {

/// Calls body(k) once for every k in [0, n), in any order and on any thread.
using ForEach = SideBySide;

/// How a batch is run; nothing here changes a result.
struct RunOptions {
  int max_lanes = 0;                          ///< 1, 4 or 8; 0 takes what the processor offers
  const std::atomic<bool>* stop = nullptr;    ///< set to end early: results become `stopped`
  ForEach for_each;                           ///< runs packs side by side; empty: one by one
  int threads_per_pack = 1;                   ///< of every time step, for single large runs; needs side_by_side
  SideBySide side_by_side;                    ///< runs the threads of a step
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

/// Runs one pack of members; the result has one entry per lane.
using MemberRunner = std::function<std::vector<ExperimentResult>(std::span<const SoilMaterial>)>;

/// One result per member, in their order.
std::vector<ExperimentResult> run_members(std::span<const SoilMaterial> members,
                                          const RunOptions& options, const MemberRunner& run);

/// Runs one pack whose lanes are members at settings (a normal stress, a speed ratio, ...).
using SettingRunner = std::function<std::vector<ExperimentResult>(
    std::span<const SoilMaterial> lanes, std::span<const double> setting_of_lane)>;

/// Makes one result of a member's runs, one per setting in their order.
using SettingJoin = std::function<ExperimentResult(std::span<ExperimentResult> runs)>;

/// Runs every member at every setting and joins the runs of each. Runs of one setting stand together
/// in the packs, since they take alike.
std::vector<ExperimentResult> run_settings(std::span<const SoilMaterial> members,
                                           std::span<const double> settings,
                                           const RunOptions& options, const SettingRunner& run,
                                           const SettingJoin& join);

/// What the runs of one member have in common: the first failure with its label before the message,
/// or `completed` with the given message; all steps, the largest inertial number, no features.
ExperimentResult joined_status(std::span<const ExperimentResult> runs,
                               const std::function<std::string(std::size_t run)>& label,
                               const std::string& completed_message);

}  // namespace tilth
