// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Elementary effects: which parameters matter, and which act unevenly or together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "calibrate/packing_noise.hpp"
#include "calibrate/sample_rows.hpp"
#include "calibrate/sensitivity_index.hpp"

namespace tilth {

/// Step of a grid of `levels` values 0, 1/(p-1), ..., 1 per parameter:  delta = p / (2 (p - 1)).
/// @pre levels even, >= 4 (2 would try the bounds only)
double morris_step(int levels);

/// One trajectory: the start on the grid, then one parameter after the other moved by delta, up
/// from the lower half of its levels, down from the upper half.
/// @shape start_levels (num_free), each in [0, levels); order: a permutation of 0 ... num_free - 1
/// @shape result (num_free, num_free + 1)
Eigen::MatrixXd morris_trajectory(std::span<const int> start_levels, std::span<const int> order,
                                  int levels);

/// num_rows trajectories; a larger number begins with those of a smaller one. Starts are the cells
/// of nested_points(), orders are drawn.
/// @source Morris, Technometrics 33 (1991) 161
std::vector<SampleRow> morris_rows(int num_rows, int num_free, int levels, std::uint64_t seed);

/// Terms of one feature: num_noise_terms of the noise, then of every parameter the effect, its
/// size and its square,
///   d_j = [y(u + delta e_j) - y(u)] / delta,   |d_j|,   d_j^2.
/// An effect needs both of its runs, and no others.
RowTerms morris_terms(const std::vector<SampleRow>& rows, const RowOutputs& outputs);

/// The order of the estimates: mu of all parameters, mu_star, sigma; then the noise share.
///
///   mu = mean d,   mu_star = mean |d|,   sigma^2 = var d - 2 v / delta^2   (n - 1; not below 0)
///
/// v is the independent packing noise (packing_noise.hpp); what a packing adds to all runs of a
/// trajectory alike is in no difference. mu needs no correction, mu_star gets none: see
/// morris_noise_floor().
/// @source Morris 1991; mu_star Campolongo, Cariboni & Saltelli, Environ. Model. Softw. 22 (2007)
///         1509; correction: own derivation, docs/theory/sensitivity.md
RowStatistic morris_statistic(int num_free, int levels, int num_packings);

/// mu_star of a parameter that does nothing:  E|d| = 2 sqrt(v) / (delta sqrt(pi)), for normal
/// noise.
double morris_noise_floor(double independent_noise, int levels);

/// What the entries of morris_statistic() are, without the noise share.
std::vector<IndexEstimate> morris_index_list(std::size_t num_free);

}  // namespace tilth
