// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Estimates that are functions of means over rows, and their bootstrap intervals.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace tilth {

/// Contributions of every row to every term. A term's mean is sum / count over the rows: what a
/// failed run left out is in neither, so each term uses all rows that are complete for *it*.
struct RowTerms {
  Eigen::MatrixXd sums;    ///< (num_terms, num_rows)
  Eigen::MatrixXd counts;  ///< (num_terms, num_rows)

  RowTerms(Eigen::Index num_terms, Eigen::Index num_rows);
  /// Books one value; NaN books nothing.
  void add(Eigen::Index term, Eigen::Index row, double value);
};

/// Estimates from the means and numbers of values of all terms; NaN where they give none.
using RowStatistic =
    std::function<Eigen::VectorXd(const Eigen::VectorXd& means, const Eigen::VectorXd& counts)>;

struct RowEstimates {
  Eigen::VectorXd values;
  Eigen::VectorXd low95, high95;  ///< NaN where a fifth of the resamples or more gave no estimate
};

/// The estimates on all rows, without intervals.
Eigen::VectorXd estimate(const RowTerms& terms, const RowStatistic& statistic);

/// With percentile intervals: rows are drawn with replacement num_resamples times, and the interval
/// runs from the 2.5 to the 97.5 % quantile of the resampled estimates.
///
/// Rows are taken as independent. For rows of a Sobol sequence the intervals are too wide, since
/// such rows avoid each other; they are never made for that too narrow. Deterministic in `seed`.
/// @source Efron & Tibshirani, An Introduction to the Bootstrap, 1993, section 13.3; for Sobol
///         indices Archer, Saltelli & Sobol, J. Stat. Comput. Simul. 58 (1997) 99
RowEstimates bootstrap(const RowTerms& terms, const RowStatistic& statistic, int num_resamples,
                       std::uint64_t seed);

}  // namespace tilth
