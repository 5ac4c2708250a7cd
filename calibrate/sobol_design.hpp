// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Evenly spread points of the unit cube.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace tilth {

inline constexpr int max_sobol_dimensions = 16;

/// The first num_points of the Sobol sequence in Gray-code order, first point 0, each number
/// k / 2^32. Dimension 1 is 0, 1/2, 3/4, 1/4, 3/8, 7/8, 5/8, 1/8, ...
/// @shape result (num_dimensions, num_points)
/// @pre 1 <= num_dimensions <= max_sobol_dimensions, 0 <= num_points < 2^31
/// @source Sobol 1967; direction numbers Joe & Kuo, SIAM J. Sci. Comput. 30 (2008) 2635,
///         table new-joe-kuo-6.21201
Eigen::MatrixXd sobol_points(int num_points, int num_dimensions);

/// The same with a digital shift: in each dimension all numbers are XOR-ed with one random 32-bit
/// word and moved to the middle of their 2^-32 cell, so that all lie strictly inside (0, 1). The
/// shift keeps the equidistribution: the first 2^k points put one point in each of 2^k strata of
/// every dimension.
Eigen::MatrixXd shifted_sobol_points(int num_points, int num_dimensions, std::uint64_t seed);

}  // namespace tilth
