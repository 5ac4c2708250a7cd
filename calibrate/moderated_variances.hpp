// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Variances from few repeats, pulled towards what is known of such variances.
#pragma once

#include <Eigen/Core>

namespace tilth {

/// Sample variances of the rows, divisor runs - 1; 0 for fewer than two runs.
/// @shape samples (m, runs)
Eigen::VectorXd sample_variances(const Eigen::MatrixXd& samples);

/// v* = (d0 v_prior + df v) / (d0 + df), df = runs - 1: a handful of repeats knows a variance to a
/// factor of two at best.
/// @shape samples (m, runs), prior (m); @pre prior_freedom + df > 0
/// @source Smyth, Stat. Appl. Genet. Mol. Biol. 3 (2004) article 3
Eigen::VectorXd moderated_variances(const Eigen::MatrixXd& samples, const Eigen::VectorXd& prior,
                                    double prior_freedom);

}  // namespace tilth
