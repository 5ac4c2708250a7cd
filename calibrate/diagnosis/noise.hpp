// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The noise of averaged measurements minus averaged simulations, from few replicates.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "calibrate/diagnosis/thresholds.hpp"

namespace tilth {

/// What was measured and simulated repeatedly in one test, whose statistics share their specimens.
struct TestSamples {
  std::vector<Eigen::Index> statistics;  ///< (m) rows of the evidence this test gives
  Eigen::MatrixXd replicates;            ///< (n, m), one row per specimen, n >= 1
  Eigen::MatrixXd packings;  ///< (S, m), one row per packing at the fitted values, S >= 1
};

/// What is known of the noise before the replicates are looked at; (p) each, in squared units of
/// the statistics (log units: squared coefficients of variation).
struct NoisePriors {
  Eigen::VectorXd replicate_variances;  ///< of one specimen, > 0
  Eigen::VectorXd packing_variances;    ///< of one packing, > 0
  /// Added to V as they are: numerical adequacy (squared halving shifts) and emulator; may be
  /// empty.
  Eigen::VectorXd additional_variances;
  double freedom = diagnosis_thresholds::moderation_freedom;     ///< d0, >= 0
  double correlation = diagnosis_thresholds::prior_correlation;  ///< within one test, in [0, 1)
};

/// Covariance of one row of samples: moderated variances (calibrate/moderated_variances.hpp) and
/// one correlation for the whole test.
///
///   C_ij = r* sqrt(v*_i v*_j),   r* = (d0 r_prior + df rbar) / (d0 + df),
///
/// rbar the mean sample correlation of the test's pairs (0 where a statistic does not scatter),
/// r* kept in [0, 0.95]: positive definite at any m, and a test cannot gain by statistics that are
/// thought to cancel. With m (m - 1) / 2 entries and n - 1 rows a free matrix would be singular.
/// Plug-in variances turn a nominal 5 % test of the largest score into 28 % false alarms, moderated
/// ones into 6 % (docs/theory/diagnosis.md).
/// @shape samples (rows, m), prior_variances (m)
Eigen::MatrixXd moderated_covariance(const Eigen::MatrixXd& samples,
                                     const Eigen::VectorXd& prior_variances, double prior_freedom,
                                     double prior_correlation);

/// Parts of the covariance V of residuals; blocks on the diagonal, one per test, zero between
/// tests.
struct NoiseCovariance {
  Eigen::MatrixXd replicate;   ///< (p, p) of the mean over n specimens
  Eigen::MatrixXd packing;     ///< (p, p) of the mean over S packings
  Eigen::MatrixXd additional;  ///< (p, p), diagonal
  Eigen::MatrixXd total() const { return replicate + packing + additional; }
};

/// V = S_exp / n + S_sim / S + V_num + V_emu with both samples moderated.
/// @throws std::invalid_argument if shapes disagree, a test has no rows, a statistic belongs to no
///         test or to two, or a prior variance is not positive
NoiseCovariance noise_covariance(const std::vector<TestSamples>& tests, const NoisePriors& priors);

/// The same specimens and packings drawn anew from a normal distribution with mean zero and the
/// moderated covariance of `tests`: what a repetition of the campaign would give if nothing is
/// missing.
std::vector<TestSamples> drawn_samples(const std::vector<TestSamples>& tests,
                                       const NoisePriors& priors, std::mt19937_64& rng);

/// Specimens and packings drawn with replacement within every test (whole rows).
std::vector<TestSamples> resampled(const std::vector<TestSamples>& tests, std::mt19937_64& rng);

/// (p) mean over specimens minus mean over packings.
Eigen::VectorXd mean_difference(const std::vector<TestSamples>& tests, Eigen::Index num_statistics);

}  // namespace tilth
