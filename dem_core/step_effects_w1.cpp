// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The step kernels with effects for 1 lane(s); compile flags of this file: dem_core/CMakeLists.txt.
#include "dem_core/integrate_kernel.hpp"

namespace tilth::lanes {
template void step_lanes_with_effects<1>(const StepView&);
template struct BlockStepWithEffects<1>;
}  // namespace tilth::lanes
