// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Stepping a specimen whose lanes follow the same protocol at their own pace.
#pragma once

#include <functional>

#include "dem_core/step.hpp"
#include "experiments/batch.hpp"
#include "experiments/specimen.hpp"

namespace tilth {

/// A specimen under test. A lane is active until its protocol finishes it or it diverges.
struct LaneRun {
  Specimen specimen;
  Workspace workspace;
  std::vector<ExperimentResult> results;
  /// [wall][lane]: force on the wall averaged over the last interval [N].
  std::vector<Vec3> mean_wall_force_N;

  /// [tool][lane]: force on the tool and torque about its origin, averaged likewise.
  std::vector<Vec3> mean_tool_force_N;
  std::vector<Vec3> mean_tool_torque_N_m;

  explicit LaneRun(Specimen s);
  int num_lanes() const { return specimen.model.num_lanes(); }
  bool active(int lane) const { return specimen.state.active[static_cast<std::size_t>(lane)] != 0; }
  Vec3 wall_force_N(int wall, int lane) const {
    return mean_wall_force_N[static_cast<std::size_t>(wall * num_lanes() + lane)];
  }
  Vec3 tool_force_N(int tool, int lane) const {
    return mean_tool_force_N[static_cast<std::size_t>(tool * num_lanes() + lane)];
  }
  Vec3 tool_torque_N_m(int tool, int lane) const {
    return mean_tool_torque_N_m[static_cast<std::size_t>(tool * num_lanes() + lane)];
  }
  double dt_s(int lane) const { return specimen.model.lanes[static_cast<std::size_t>(lane)].dt_s; }
  double time_s(int lane) const {
    return specimen.state.time_s[static_cast<std::size_t>(lane)];
  }
  /// Freezes a lane with this status and message.
  void finish(int lane, RunStatus status, const std::string& message);
};

/// Changes the time step of one lane between intervals; servos must be told anew.
void set_time_step(LaneRun& run, int lane, double dt_s);

/// Changes the friction between the grains of one lane between intervals.
void set_friction(LaneRun& run, int lane, double friction);

/// Changes rolling friction and the laws beyond the baseline of one lane between intervals.
void set_effects(LaneRun& run, int lane, double rolling_friction, const EffectLaw& effects);

/// Changes the local damping of one lane between intervals.
void set_local_damping(LaneRun& run, int lane, double local_damping);

/// Called once per interval for every active lane; ends a lane with run.finish().
using LaneProtocol = std::function<void(LaneRun& run, int lane)>;

/// Steps in intervals and calls the protocol until every lane has ended. Lanes that diverge, and
/// lanes still active after max_steps, end as failures that say where they stood.
void run_protocol(LaneRun& run, int interval_steps, std::int64_t max_steps,
                  const RunOptions& options, const LaneProtocol& protocol);

}  // namespace tilth
