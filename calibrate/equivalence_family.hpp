// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// A handful of parameter sets that fit equally well, as unlike each other as possible.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tilth {

/// Farthest-point selection: starting from column 0, again and again the column whose nearest chosen
/// one is farthest away (Euclidean, unit cube), until `most` are chosen or the next would be closer
/// than `least_distance`. Ties go to the lower column.
/// @return chosen columns, in order of choice
/// @source Gonzalez, Theoretical Computer Science 38 (1985) 293
std::vector<Eigen::Index> farthest_columns(const Eigen::MatrixXd& points, int most,
                                           double least_distance);

}  // namespace tilth
