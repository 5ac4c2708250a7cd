// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The step kernels with effects for 8 lane(s); compile flags of this file: dem_core/CMakeLists.txt.
#include "dem_core/integrate_kernel.hpp"

namespace tilth::lanes {
template void step_lanes_with_effects<8>(const StepView&);
template struct BlockStepWithEffects<8>;
}  // namespace tilth::lanes
