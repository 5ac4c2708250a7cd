// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Sobol indices: the share of a feature's variance that each parameter, and each pair, explains.
#pragma once

#include <cstdint>
#include <vector>

#include "calibrate/packing_noise.hpp"
#include "calibrate/sample_rows.hpp"
#include "calibrate/sensitivity_index.hpp"

namespace tilth {

/// Points per row: 2 d + 2.
Eigen::Index num_saltelli_points(int num_free);

/// num_rows rows  A, AB_1 ... AB_d, BA_1 ... BA_d, B : AB_j is A with coordinate j of B, BA_j is B
/// with coordinate j of A. (A, B) is a point of nested_points() in 2 d dimensions, so a larger
/// number of rows begins with those of a smaller one. Powers of two are spread most evenly.
/// @source Saltelli, Comput. Phys. Commun. 145 (2002) 280
std::vector<SampleRow> saltelli_rows(int num_rows, int num_free, std::uint64_t seed);

/// The points A of the same design alone, one per row: what an emulator is made of.
std::vector<SampleRow> saltelli_base_rows(int num_rows, int num_free, std::uint64_t seed);

/// Terms of one feature: num_noise_terms of the noise, then per row (a, b, ab_j, ba_j centred)
///   of every parameter   b (ab_j - a)  and  a (ba_j - b),
///   of every parameter   (a - ab_j)^2 / 2  and  (b - ba_j)^2 / 2,
///   of every pair j < k  ba_j ab_k - a b  and  ba_k ab_j - a b.
/// A product needs its own runs, and no others.
RowTerms sobol_terms(const RowOutputs& outputs);

/// The order of the estimates: S of all parameters, ST, S_jk (pairs j < k, row by row); then the
/// noise share. With V = NoiseSplit::parameters, v = NoiseSplit::independent and means M of the
/// terms:
///
///   S_j = M_first,j / V,   ST_j = (M_total,j - v) / V,   S_jk = M_pair,jk / V - S_j - S_k
///
/// A packing shared by a row enters a, b, ab_j and ba_j alike: it drops out of the first and the
/// second kind of term, and of the third by subtracting a b. Independent noise has no mean in
/// products of different runs, but adds v to half a squared difference. NaN if V <= 0: all the
/// variance is noise.
/// @source S: Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, table 2 (b); ST: Jansen,
///         Comput. Phys. Commun. 117 (1999) 35; S_jk: Saltelli 2002; noise: own derivation,
///         docs/theory/sensitivity.md
RowStatistic sobol_statistic(int num_free, int num_packings);

/// What the entries of sobol_statistic() are, without the noise share.
std::vector<IndexEstimate> sobol_index_list(std::size_t num_free);

}  // namespace tilth
