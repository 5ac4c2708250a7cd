// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/lane_run.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tilth {
namespace {

void note_diverged(LaneRun& run) {
  for (int lane = 0; lane < run.num_lanes(); ++lane) {
    ExperimentResult& r = run.results[static_cast<std::size_t>(lane)];
    if (run.active(lane) || r.num_steps > 0) continue;
    r.status = RunStatus::diverged;
    r.num_steps = run.specimen.state.num_steps;
    r.message = fmt::format("diverged at step {} (t = {:.4g} s): a grain moved more than a quarter "
                            "of the smallest radius in one step, or its position is not finite",
                            r.num_steps, run.time_s(lane));
  }
}

void step_interval(LaneRun& run, int interval_steps) {
  for (auto* mean : {&run.mean_wall_force_N, &run.mean_tool_force_N, &run.mean_tool_torque_N_m})
    std::ranges::fill(*mean, Vec3::Zero());
  const int num_walls = static_cast<int>(run.specimen.model.walls.size());
  const int num_tools = static_cast<int>(run.specimen.model.tools.size());
  for (int n = 0; n < interval_steps; ++n) {
    const StepInfo info = step(run.specimen.model, run.specimen.state, run.workspace);
    for (int w = 0; w < num_walls; ++w)
      for (int lane = 0; lane < run.num_lanes(); ++lane)
        run.mean_wall_force_N[static_cast<std::size_t>(w * run.num_lanes() + lane)] +=
            run.specimen.state.wall_force_N(w, lane);
    for (int t = 0; t < num_tools; ++t)
      for (int lane = 0; lane < run.num_lanes(); ++lane) {
        const auto k = static_cast<std::size_t>(t * run.num_lanes() + lane);
        run.mean_tool_force_N[k] += run.specimen.state.tool_force_N(t, lane);
        run.mean_tool_torque_N_m[k] += run.specimen.state.tool_torque_N_m(t, lane);
      }
    if (info.lane_failed) note_diverged(run);
    if (!info.any_active) break;
  }
  for (auto* mean : {&run.mean_wall_force_N, &run.mean_tool_force_N, &run.mean_tool_torque_N_m})
    for (Vec3& f : *mean) f /= interval_steps;
}

}  // namespace

LaneRun::LaneRun(Specimen s)
    : specimen(std::move(s)),
      results(specimen.model.lanes.size()),
      mean_wall_force_N(specimen.model.walls.size() * specimen.model.lanes.size(), Vec3::Zero()),
      mean_tool_force_N(specimen.model.tools.size() * specimen.model.lanes.size(), Vec3::Zero()),
      mean_tool_torque_N_m(mean_tool_force_N) {
  for (int lane = 0; lane < num_lanes(); ++lane)
    results[static_cast<std::size_t>(lane)].dt_s = dt_s(lane);
}

void LaneRun::finish(int lane, RunStatus status, const std::string& message) {
  ExperimentResult& r = results[static_cast<std::size_t>(lane)];
  r.status = status;
  r.message = message;
  r.num_steps = specimen.state.num_steps;
  specimen.state.active[static_cast<std::size_t>(lane)] = 0;
  model_changed(workspace);
}

void set_time_step(LaneRun& run, int lane, double dt_s) {
  run.specimen.model.lanes[static_cast<std::size_t>(lane)].dt_s = dt_s;
  run.results[static_cast<std::size_t>(lane)].dt_s = dt_s;
  model_changed(run.workspace);
}

void set_friction(LaneRun& run, int lane, double friction) {
  run.specimen.model.lanes[static_cast<std::size_t>(lane)].friction = friction;
  model_changed(run.workspace);
}

void set_effects(LaneRun& run, int lane, double rolling_friction, const EffectLaw& effects) {
  LaneLaw& law = run.specimen.model.lanes[static_cast<std::size_t>(lane)];
  law.rolling_friction = rolling_friction;
  law.effects = effects;
  model_changed(run.workspace);
}

void set_local_damping(LaneRun& run, int lane, double local_damping) {
  run.specimen.model.lanes[static_cast<std::size_t>(lane)].local_damping = local_damping;
  model_changed(run.workspace);
}

void run_protocol(LaneRun& run, int interval_steps, std::int64_t max_steps,
                  const RunOptions& options, const LaneProtocol& protocol) {
  run.workspace.num_threads = options.threads_per_pack;
  run.workspace.side_by_side = options.side_by_side;
  if (options.threads_per_pack > 1) model_changed(run.workspace);  // the list is cut for them
  const auto any_active = [&run] {
    return std::ranges::any_of(run.specimen.state.active, [](auto a) { return a != 0; });
  };
  while (any_active()) {
    step_interval(run, interval_steps);
    const bool asked_to_stop = options.stop && options.stop->load(std::memory_order_relaxed);
    const bool too_long = run.specimen.state.num_steps >= max_steps;
    for (int lane = 0; lane < run.num_lanes(); ++lane) {
      if (!run.active(lane)) continue;
      protocol(run, lane);
      if (!run.active(lane)) continue;
      if (asked_to_stop) run.finish(lane, RunStatus::stopped, "stopped on request");
      else if (too_long)
        run.finish(lane, RunStatus::not_settled,
                   fmt::format("did not reach its end within {} steps (t = {:.4g} s)", max_steps,
                               run.time_s(lane)));
    }
  }
}

}  // namespace tilth
