// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/moderated_variances.hpp"

namespace tilth {
namespace {

constexpr double max_correlation = 0.95;

Eigen::MatrixXd centred(const Eigen::MatrixXd& samples) {
  return samples.rowwise() - samples.colwise().mean();
}

// Mean correlation of all pairs of columns; 0 for a pair in which one does not scatter.
double mean_correlation(const Eigen::MatrixXd& samples) {
  const Eigen::MatrixXd deviations = centred(samples);
  const Eigen::VectorXd norms = deviations.colwise().norm();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < samples.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (norms[i] > 0.0 && norms[j] > 0.0)
        sum += deviations.col(i).dot(deviations.col(j)) / (norms[i] * norms[j]);
  const auto m = static_cast<double>(samples.cols());
  return m > 1.0 ? 2.0 * sum / (m * (m - 1.0)) : 0.0;
}

Eigen::MatrixXd prior_moderated(const Eigen::MatrixXd& samples, const TestSamples& test,
                                const Eigen::VectorXd& variances, const NoisePriors& priors) {
  return moderated_covariance(samples, variances(test.statistics), priors.freedom,
                              priors.correlation);
}

void check(const std::vector<TestSamples>& tests, const NoisePriors& priors) {
  const Eigen::Index p = priors.replicate_variances.size();
  std::vector<int> times(static_cast<std::size_t>(p), 0);
  for (const TestSamples& test : tests) {
    const auto m = static_cast<Eigen::Index>(test.statistics.size());
    if (test.replicates.cols() != m || test.packings.cols() != m || test.replicates.rows() < 1 ||
        test.packings.rows() < 1)
      throw std::invalid_argument(
          "every test needs at least one specimen and one packing, with one column per statistic");
    for (const Eigen::Index i : test.statistics) ++times.at(static_cast<std::size_t>(i));
  }
  const bool each_once = std::ranges::all_of(times, [](int n) { return n == 1; });
  const bool positive = priors.packing_variances.size() == p &&
                        (priors.replicate_variances.array() > 0.0).all() &&
                        (priors.packing_variances.array() > 0.0).all();
  if (!each_once || !positive)
    throw std::invalid_argument(
        "every statistic needs one test and prior variances of specimens and packings above zero");
}

Eigen::MatrixXd drawn(Eigen::Index num_rows, const Eigen::MatrixXd& covariance,
                      std::mt19937_64& rng) {
  const Eigen::MatrixXd half = covariance.llt().matrixL();
  Eigen::MatrixXd numbers(num_rows, covariance.cols());
  for (double& x : numbers.reshaped()) x = standard_normal(rng);
  return numbers * half.transpose();
}

Eigen::MatrixXd drawn_rows(const Eigen::MatrixXd& rows, std::mt19937_64& rng) {
  Eigen::MatrixXd result(rows.rows(), rows.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    result.row(i) =
        rows.row(static_cast<Eigen::Index>(rng() % static_cast<std::uint64_t>(rows.rows())));
  return result;
}

}  // namespace

Eigen::MatrixXd moderated_covariance(const Eigen::MatrixXd& samples,
                                     const Eigen::VectorXd& prior_variances, double prior_freedom,
                                     double prior_correlation) {
  const Eigen::VectorXd deviation =
      moderated_variances(samples.transpose(), prior_variances, prior_freedom).cwiseSqrt();
  const auto freedom = static_cast<double>(samples.rows() - 1);
  const double correlation =
      std::clamp((prior_freedom * prior_correlation + freedom * mean_correlation(samples)) /
                     (prior_freedom + freedom),
                 0.0, max_correlation);
  Eigen::MatrixXd covariance = correlation * deviation * deviation.transpose();
  covariance.diagonal() = deviation.array().square();
  return covariance;
}

NoiseCovariance noise_covariance(const std::vector<TestSamples>& tests, const NoisePriors& priors) {
  check(tests, priors);
  const Eigen::Index p = priors.replicate_variances.size();
  NoiseCovariance v;
  v.replicate = v.packing = v.additional = Eigen::MatrixXd::Zero(p, p);
  for (const TestSamples& test : tests) {
    v.replicate(test.statistics, test.statistics) =
        prior_moderated(test.replicates, test, priors.replicate_variances, priors) /
        static_cast<double>(test.replicates.rows());
    v.packing(test.statistics, test.statistics) =
        prior_moderated(test.packings, test, priors.packing_variances, priors) /
        static_cast<double>(test.packings.rows());
  }
  if (priors.additional_variances.size() > 0) v.additional.diagonal() = priors.additional_variances;
  return v;
}

std::vector<TestSamples> drawn_samples(const std::vector<TestSamples>& tests,
                                       const NoisePriors& priors, std::mt19937_64& rng) {
  std::vector<TestSamples> result = tests;
  for (TestSamples& test : result) {
    test.replicates =
        drawn(test.replicates.rows(),
              prior_moderated(test.replicates, test, priors.replicate_variances, priors), rng);
    test.packings =
        drawn(test.packings.rows(),
              prior_moderated(test.packings, test, priors.packing_variances, priors), rng);
  }
  return result;
}

std::vector<TestSamples> resampled(const std::vector<TestSamples>& tests, std::mt19937_64& rng) {
  std::vector<TestSamples> result = tests;
  for (TestSamples& test : result) {
    test.replicates = drawn_rows(test.replicates, rng);
    test.packings = drawn_rows(test.packings, rng);
  }
  return result;
}

Eigen::VectorXd mean_difference(const std::vector<TestSamples>& tests,
                                Eigen::Index num_statistics) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(num_statistics);
  for (const TestSamples& test : tests)
    mean(test.statistics) = test.replicates.colwise().mean() - test.packings.colwise().mean();
  return mean;
}

}  // namespace tilth
