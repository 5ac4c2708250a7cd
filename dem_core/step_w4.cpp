// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The step kernels for 4 lane(s); compile flags of this file: dem_core/CMakeLists.txt.
#include "dem_core/integrate_kernel.hpp"

namespace tilth::lanes {
template void step_lanes<4>(const StepView&);
template struct BlockStep<4>;
}  // namespace tilth::lanes
