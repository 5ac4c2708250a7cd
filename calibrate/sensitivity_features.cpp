// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/emulator.hpp"
#include "calibrate/missing_bounds.hpp"
#include "calibrate/morris.hpp"
#include "calibrate/sensitivity_stages.hpp"
#include "calibrate/sobol_indices.hpp"

namespace tilth {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t bootstrap_stream = 21;
constexpr std::uint64_t integration_stream = 22;
constexpr int num_integration_rows = 2048;  // of the emulator; its integration error is below 0.01

RowTerms terms_of(const std::vector<SampleRow>& rows, const RowOutputs& outputs,
                  SensitivityMethod method) {
  return method == SensitivityMethod::morris ? morris_terms(rows, outputs) : sobol_terms(outputs);
}

RowStatistic statistic_of(int num_free, const SensitivityOptions& o) {
  return o.method == SensitivityMethod::morris
             ? morris_statistic(num_free, o.levels, o.packings.num_packings)
             : sobol_statistic(num_free, o.packings.num_packings);
}

// Terms behind index i: Morris keeps mu, mu_star, sigma in blocks of their own terms, Sobol too.
void set_indices(const RowTerms& terms, const RowEstimates& estimates, FeatureSensitivity& f) {
  for (std::size_t i = 0; i < f.indices.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    f.indices[i].value = estimates.values[k];
    f.indices[i].low95 = estimates.low95[k];
    f.indices[i].high95 = estimates.high95[k];
    f.indices[i].num_values = static_cast<std::size_t>(terms.counts.row(num_noise_terms + k).sum());
  }
}

void set_noise(const RowTerms& terms, const SensitivityOptions& o, FeatureSensitivity& f) {
  const Eigen::VectorXd counts = terms.counts.rowwise().sum();
  const Eigen::VectorXd sums = terms.sums.rowwise().sum();
  const Eigen::VectorXd means = (counts.array() > 0).select(sums.cwiseQuotient(counts), nan_value);
  f.noise = noise_split(means, counts, o.packings.num_packings);
  if (o.method == SensitivityMethod::morris && !std::isnan(f.noise.noise_share))
    f.noise_floor = morris_noise_floor(f.noise.independent, o.levels);
}

// Of rows that give no indices themselves.
void set_noise_interval(const RowTerms& terms, const SensitivityOptions& o, FeatureSensitivity& f) {
  const auto share = [&](const Eigen::VectorXd& means, const Eigen::VectorXd& counts) {
    const NoiseSplit split = noise_split(means, counts, o.packings.num_packings);
    return Eigen::VectorXd::Constant(1, split.noise_share).eval();
  };
  const RowEstimates estimates = bootstrap(terms, share, o.num_resamples,
                                           design_word(o.packings.first_seed, bootstrap_stream, 0));
  f.noise_low95 = estimates.low95[0];
  f.noise_high95 = estimates.high95[0];
}

void set_bounds(const std::vector<SampleRow>& rows, const RowOutputs& outputs,
                const RowStatistic& statistic, SensitivityMethod method, FeatureSensitivity& f) {
  const std::vector<RowOutputs> scenarios = filled_outputs(rows, outputs);
  if (scenarios.empty()) return;
  for (IndexEstimate& index : f.indices) index.bound_low = index.bound_high = index.value;
  for (const RowOutputs& scenario : scenarios) {
    const Eigen::VectorXd values = estimate(terms_of(rows, scenario, method), statistic);
    for (std::size_t i = 0; i < f.indices.size(); ++i) {
      IndexEstimate& index = f.indices[i];
      const double value = values[static_cast<Eigen::Index>(i)];
      index.bound_low = std::fmin(index.bound_low, value);
      index.bound_high = std::fmax(index.bound_high, value);
    }
  }
}

FailurePattern pattern_of(const std::vector<SampleRow>& rows, const RowOutputs& outputs) {
  return failure_pattern(rows, outputs.values.array().isNaN().cast<double>().matrix());
}

bool wants_bounds(const FailurePattern& pattern) {
  return pattern.verdict == FailureVerdict::concentrated ||
         pattern.verdict == FailureVerdict::too_few;
}

std::string reason_for_none(const FeatureSensitivity& f) {
  const bool has_any = std::ranges::any_of(
      f.indices, [](const IndexEstimate& index) { return !std::isnan(index.value); });
  if (has_any) return {};
  if (f.failures.num_failed == f.failures.num_runs) return "all runs failed";
  if (f.noise.total == 0.0) return "the feature does not vary at all";
  if (f.noise.parameters <= 0.0) return "the packing noise is as large as the whole variance";
  return "too few completed runs";
}

Eigen::MatrixXd completed_points(const std::vector<SampleRow>& rows, const RowOutputs& outputs,
                                 Eigen::VectorXd& values) {
  const Eigen::Index d = rows.front().unit.rows();
  Eigen::MatrixXd points(d, outputs.values.cols());
  values.resize(outputs.values.cols());
  Eigen::Index n = 0;
  for (Eigen::Index r = 0; r < outputs.values.cols(); ++r) {
    if (std::isnan(outputs.values(0, r))) continue;
    points.col(n) = rows[static_cast<std::size_t>(r)].unit.col(0);
    values[n++] = outputs.values(0, r);
  }
  values.conservativeResize(n);
  return points.leftCols(n);
}

RowOutputs emulated_outputs(const Emulator& emulator, const std::vector<SampleRow>& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  RowOutputs outputs{Eigen::MatrixXd(rows.front().unit.cols(), n),
                     Eigen::MatrixXd::Constant(2, n, nan_value)};
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index i = 0; i < outputs.values.rows(); ++i)
      outputs.values(i, r) = emulator.predict_mean(rows[static_cast<std::size_t>(r)].unit.col(i));
  return outputs;
}

void set_emulator_error(const Emulator& emulator, FeatureSensitivity& f) {
  const LeaveOneOut check = emulator.leave_one_out();
  f.emulator.q2 = check.q2;
  f.emulator.rms =
      std::sqrt(check.residuals.squaredNorm() / static_cast<double>(check.residuals.size()));
}

}  // namespace

void analyse_rows(const std::vector<SampleRow>& rows, const RowOutputs& outputs,
                  const SensitivityOptions& o, FeatureSensitivity& f) {
  f.failures = pattern_of(rows, outputs);
  const int num_free = static_cast<int>(rows.front().unit.rows());
  f.indices = o.method == SensitivityMethod::morris
                  ? morris_index_list(static_cast<std::size_t>(num_free))
                  : sobol_index_list(static_cast<std::size_t>(num_free));
  const RowTerms terms = terms_of(rows, outputs, o.method);
  const RowStatistic statistic = statistic_of(num_free, o);
  const RowEstimates estimates = bootstrap(terms, statistic, o.num_resamples,
                                           design_word(o.packings.first_seed, bootstrap_stream, 0));
  set_indices(terms, estimates, f);
  set_noise(terms, o, f);
  const Eigen::Index last = estimates.values.size() - 1;
  f.noise_low95 = estimates.low95[last];
  f.noise_high95 = estimates.high95[last];
  f.no_indices = reason_for_none(f);
  if (wants_bounds(f.failures)) set_bounds(rows, outputs, statistic, o.method, f);
}

void analyse_emulator(const std::vector<SampleRow>& rows, const RowOutputs& outputs,
                      const SensitivityOptions& o, FeatureSensitivity& f) {
  f.failures = pattern_of(rows, outputs);
  RowTerms noise_terms(num_noise_terms, outputs.values.cols());
  add_noise_terms(outputs, centre_of(outputs), noise_terms);
  set_noise(noise_terms, o, f);
  set_noise_interval(noise_terms, o, f);
  Eigen::VectorXd values;
  const Eigen::MatrixXd points = completed_points(rows, outputs, values);
  const int d = static_cast<int>(points.rows());
  if (values.size() < min_emulator_points(EmulatorTrend::linear, d)) {
    f.no_indices = "too few completed runs for an emulator";
    return;
  }
  const Emulator emulator(points, values, {});
  set_emulator_error(emulator, f);
  const std::uint64_t seed = design_word(o.packings.first_seed, integration_stream, 0);
  const RowOutputs emulated =
      emulated_outputs(emulator, saltelli_rows(num_integration_rows, d, seed));
  const RowTerms terms = sobol_terms(emulated);
  f.indices = sobol_index_list(static_cast<std::size_t>(d));
  set_indices(terms, bootstrap(terms, sobol_statistic(d, 1), o.num_resamples, seed), f);
  f.no_indices = reason_for_none(f);
}

}  // namespace tilth
