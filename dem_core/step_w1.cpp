// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The step kernels for 1 lane(s); compile flags of this file: dem_core/CMakeLists.txt.
#include "dem_core/integrate_kernel.hpp"

namespace tilth::lanes {
template void step_lanes<1>(const StepView&);
template struct BlockStep<1>;
}  // namespace tilth::lanes
