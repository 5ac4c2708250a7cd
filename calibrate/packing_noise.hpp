// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// How much of a feature's variance comes from the packing, split by what it does to differences.
#pragma once

#include "calibrate/row_bootstrap.hpp"
#include "calibrate/sample_rows.hpp"

namespace tilth {

/// Variances of one feature over a study, y = f(parameters, packing):
///
///   total    = parameters + independent + (1 - 1/K) shared          over the rows of K packings
///   shared       variance of what a packing adds to every parameter set alike; cancels in
///                differences within a row
///   independent  variance of the rest of the packing's effect; does not cancel
///   parameters   variance of the mean over packings: what the indices are shares of
struct NoiseSplit {
  double mean = 0.0;
  double total = 0.0;
  double parameters = 0.0;
  double shared = 0.0;       ///< 0 if not measured
  double independent = 0.0;  ///< 0 if not measured
  /// (shared + independent) / (parameters + shared + independent): of one run on any packing.
  /// NaN if no row was repeated.
  double noise_share = 0.0;
};

/// Terms 0 ... num_noise_terms - 1 of every study.
inline constexpr Eigen::Index num_noise_terms = 4;

/// Books, with y_1, y_2 the ends of a row and z_1, z_2 the same on the second packing:
///   y_e - centre,  (y_e - centre)^2,  (y_e - z_e)^2 / 2,  (y_1 - z_1)(y_2 - z_2) / 2,
/// whose means are the feature's mean, its second moment, shared + independent, and shared: the two
/// differences of the last have in common only what the two packings do to every parameter set.
/// @source own derivation, docs/theory/sensitivity.md
void add_noise_terms(const RowOutputs& outputs, double centre, RowTerms& terms);

/// The split from the means of these terms. Rows of one point cannot tell shared from independent;
/// all is independent then. Negative estimates become 0.
NoiseSplit noise_split(const Eigen::VectorXd& means, const Eigen::VectorXd& counts,
                       int num_packings);

/// Mean of the ends of all rows: close to the feature's mean, subtracted before products are
/// formed.
double centre_of(const RowOutputs& outputs);

}  // namespace tilth
