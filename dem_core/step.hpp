// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// One time step of all lanes, and the processor's widest lane count.
#pragma once

#include "dem_core/state.hpp"

namespace tilth {

/// What a guard needs to know after a step.
struct StepInfo {
  bool rebuilt = false;   ///< the neighbour list was rebuilt
  bool any_active = true;
  bool lane_failed = false;  ///< a lane was frozen in this step because it diverged
};

/// One step: move walls and tools, rebuild the neighbour list if it may have run short, forces of
/// pairs, bonds, walls and tools, semi-implicit Euler v += dt F/m, x += dt v for every active lane.
///
/// A lane whose fastest grain would cross more than a quarter of the smallest radius in one step, or
/// whose numbers are no longer finite, is frozen (state.active = 0) and leaves the others alone.
/// At equal dt a lane's bits depend neither on the number of lanes nor on its companions.
/// @pre problems(model) is empty; state came from initial_state(model, ...) or a snapshot
StepInfo step(const Model& model, State& state, Workspace& workspace);

/// Call after changing Model (laws, radii, references, walls, tools) between steps.
void model_changed(Workspace& workspace);

/// 8 with AVX-512, 4 with AVX2, else 1.
int widest_lanes();

/// True where step() can run W lanes on this processor.
bool lanes_supported(int num_lanes);

}  // namespace tilth
