// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/batch.hpp"

#include <algorithm>
#include <map>

#include "dem_core/step.hpp"

namespace tilth {
namespace {

struct PackPlan {
  std::vector<std::size_t> task_of_lane;
  std::size_t num_used = 0;  ///< the lanes behind them repeat the first task
};

}  // namespace

std::vector<int> pack_widths(int n, int widest) {
  std::vector<int> widths;
  while (n > 0) {
    const int width = widest >= 8 && n > 4 ? 8 : widest >= 4 && n > 1 ? 4 : 1;
    widths.push_back(width);
    n -= width;
  }
  return widths;
}

std::vector<ExperimentResult> run_in_packs(std::span<const double> density_of_task,
                                           const RunOptions& options, const PackRunner& run) {
  std::map<double, std::vector<std::size_t>> by_density;
  for (std::size_t k = 0; k < density_of_task.size(); ++k)
    by_density[density_of_task[k]].push_back(k);
  const int widest =
      options.max_lanes > 0 ? std::min(options.max_lanes, widest_lanes()) : widest_lanes();
  std::vector<PackPlan> plans;
  for (const auto& [density, ids] : by_density) {
    std::size_t next = 0;
    for (const int width : pack_widths(static_cast<int>(ids.size()), widest)) {
      const std::size_t count = std::min(ids.size() - next, static_cast<std::size_t>(width));
      PackPlan plan{std::vector<std::size_t>(static_cast<std::size_t>(width), ids[next]), count};
      for (std::size_t k = 0; k < count; ++k) plan.task_of_lane[k] = ids[next + k];
      plans.push_back(std::move(plan));
      next += count;
    }
  }
  std::vector<ExperimentResult> results(density_of_task.size());
  const auto run_plan = [&](std::size_t p) {
    std::vector<ExperimentResult> pack = run(plans[p].task_of_lane);
    for (std::size_t k = 0; k < plans[p].num_used; ++k)
      results[plans[p].task_of_lane[k]] = std::move(pack[k]);
  };
  if (options.for_each) options.for_each(plans.size(), run_plan);
  else
    for (std::size_t p = 0; p < plans.size(); ++p) run_plan(p);
  return results;
}

std::vector<ExperimentResult> run_members(std::span<const SoilMaterial> members,
                                          const RunOptions& options, const MemberRunner& run) {
  const double only[] = {0.0};
  return run_settings(
      members, only, options,
      [&run](std::span<const SoilMaterial> lanes, std::span<const double>) { return run(lanes); },
      [](std::span<ExperimentResult> runs) { return std::move(runs.front()); });
}

std::vector<ExperimentResult> run_settings(std::span<const SoilMaterial> members,
                                           std::span<const double> settings,
                                           const RunOptions& options, const SettingRunner& run,
                                           const SettingJoin& join) {
  std::vector<SoilMaterial> material_of_task;
  std::vector<double> setting_of_task, density_of_task;
  for (const double setting : settings)
    for (const SoilMaterial& m : members) {
      material_of_task.push_back(m);
      setting_of_task.push_back(setting);
      density_of_task.push_back(m.density_kg_per_m3);
    }
  std::vector<ExperimentResult> runs =
      run_in_packs(density_of_task, options, [&](std::span<const std::size_t> task_of_lane) {
        std::vector<SoilMaterial> lanes;
        std::vector<double> setting_of_lane;
        for (const std::size_t task : task_of_lane) {
          lanes.push_back(material_of_task[task]);
          setting_of_lane.push_back(setting_of_task[task]);
        }
        return run(lanes, setting_of_lane);
      });
  std::vector<ExperimentResult> results;
  for (std::size_t m = 0; m < members.size(); ++m) {
    std::vector<ExperimentResult> own;
    for (std::size_t k = 0; k < settings.size(); ++k)
      own.push_back(std::move(runs[k * members.size() + m]));
    results.push_back(join(own));
  }
  return results;
}

ExperimentResult joined_status(std::span<const ExperimentResult> runs,
                               const std::function<std::string(std::size_t run)>& label,
                               const std::string& completed_message) {
  ExperimentResult joined;
  joined.status = RunStatus::completed;
  joined.message = completed_message;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    joined.dt_s = runs[k].dt_s;
    joined.num_steps += runs[k].num_steps;
    joined.inertial_number = std::max(joined.inertial_number, runs[k].inertial_number);
    if (runs[k].status == RunStatus::completed || joined.status != RunStatus::completed) continue;
    joined.status = runs[k].status;
    joined.message = label(k) + runs[k].message;
  }
  return joined;
}

}  // namespace tilth
