// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What a sensitivity study runs: rows of points that share a packing, and what they gave.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace tilth {

/// The packings of a study: seeds first_seed ... first_seed + num_packings - 1.
struct PackingPlan {
  std::uint64_t first_seed = 1;
  int num_packings = 8;  ///< 1: the packing noise is not measured
};

/// The independent unit of a study: one Morris trajectory, one Saltelli row, or one point.
///
/// All its points are run on one packing (common random numbers): what a packing does to every
/// parameter set alike then cancels in differences. The *ends* of the row, its first and its last
/// column, differ in every parameter; in every second row they are run again on another packing,
/// which measures the packing noise (calibrate/packing_noise.hpp).
struct SampleRow {
  Eigen::MatrixXd unit;  ///< (num_free, num_points), unit cube
  std::uint64_t seed = 0;
  std::optional<std::uint64_t> repeat_seed;  ///< the ends are run on this packing as well
};

/// One feature of all rows, T of calibrate/targets.hpp. NaN: failed, or not repeated.
struct RowOutputs {
  Eigen::MatrixXd values;   ///< (num_points, num_rows)
  Eigen::MatrixXd repeats;  ///< (2, num_rows): first and last column on the second packing; the
                            ///< second row is NaN where a row has one point only
};

/// A random word that depends on (seed, stream, index) alone, so that a longer design begins with
/// the shorter one. @source SplitMix64, Steele, Lea & Flood 2014
std::uint64_t design_word(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

/// num_points of the cube that begin with those of any smaller num_points: the shifted Sobol
/// sequence up to max_sobol_dimensions, independent random points beyond.
/// @shape result (num_dimensions, num_points), strictly inside (0, 1)
Eigen::MatrixXd nested_points(int num_points, int num_dimensions, std::uint64_t seed);

/// Fills seed and repeat_seed of all rows.
///
/// Each num_packings consecutive rows use every packing once, in an order of their own; of each two
/// rows one, by lot, is repeated, on any of the other packings. Not `row % num_packings`: Sobol
/// points whose numbers are equal modulo 4 lie in one half of the cube, so the packing would be
/// confounded with the first parameters.
/// @pre plan.num_packings >= 1; with 1 nothing is repeated
void assign_packings(std::vector<SampleRow>& rows, const PackingPlan& plan);

}  // namespace tilth
