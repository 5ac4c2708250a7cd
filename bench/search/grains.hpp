// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The loamy-sand problem of the stand-in, simulated.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "calibrate/simulator.hpp"

namespace tilth::bench {

/// Preview specimens of data/soils/loamy_sand, fitted targets only, one thread.
/// @shape parameters (3, num_members): bond modulus, bond tensile strength, friction
/// @thread_safety may be called from several threads
std::function<std::vector<Evaluation>(const Eigen::MatrixXd& parameters,
                                      std::span<const std::uint64_t> seeds)>
loamy_sand_grains();

}  // namespace tilth::bench
