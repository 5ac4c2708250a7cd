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

std::vector<double> densities_kg_per_m3(std::span<const SoilMaterial> members) {
  std::vector<double> density(members.size());
  std::ranges::transform(members, density.begin(),
                         [](const SoilMaterial& m) { return m.density_kg_per_m3; });
  return density;
}

std::vector<SoilMaterial> pick(std::span<const SoilMaterial> members,
                               std::span<const std::size_t> task_of_lane) {
  std::vector<SoilMaterial> lanes;
  for (const std::size_t task : task_of_lane) lanes.push_back(members[task]);
  return lanes;
}

}  // namespace tilth
