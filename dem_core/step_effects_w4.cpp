// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The step kernels with effects for 4 lane(s); compile flags of this file: dem_core/CMakeLists.txt.
#include "dem_core/integrate_kernel.hpp"

namespace tilth::lanes {
template void step_lanes_with_effects<4>(const StepView&);
template struct BlockStepWithEffects<4>;
}  // namespace tilth::lanes
