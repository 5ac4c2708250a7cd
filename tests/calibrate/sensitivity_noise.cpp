// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/sensitivity_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

SensitivitySummary sobol_study(const std::vector<Parameter>& parameters, const Simulator& simulator,
                               const SensitivityOptions& options) {
  return run_sensitivity(parameters, {plain_target("y")}, simulator, options);
}

bool unlucky(const Eigen::VectorXd& x) { return word_of(x) % 20 == 0; }
bool in_a_corner(const Eigen::VectorXd& x) { return x[0] > 0.9 * std::numbers::pi; }

struct Sample {
  double sum = 0.0, squares = 0.0;
  int n = 0;
  void add(double v) {
    sum += v;
    squares += v * v;
    ++n;
  }
  double mean() const { return sum / n; }
  double standard_error() const { return std::sqrt((squares / n - mean() * mean()) / (n - 1)); }
};

}  // namespace

TEST_CASE(
    "Sobol: with seed noise of a quarter of the variance and 5 % of the runs deleted at "
    "random the indices have no bias",
    "[calibrate][sensitivity]") {
  const double sd = std::sqrt(ishigami_variance / 4.0);
  for (const NoiseKind kind : {NoiseKind::shared, NoiseKind::independent}) {
    std::vector<Sample> first(3), total(3);
    Sample share, failed, pair;
    for (std::uint64_t k = 0; k < 16; ++k) {
      const Simulator model = failing(noisy(ishigami, sd, kind, 100 + k), unlucky);
      const SensitivitySummary s = sobol_study(
          ishigami_parameters(), model, study(SensitivityMethod::sobol, 512, 1 + 50 * k, 32));
      for (std::size_t j = 0; j < 3; ++j) {
        first[j].add(index_of(s, IndexKind::first_order, j).value);
        total[j].add(index_of(s, IndexKind::total, j).value);
      }
      pair.add(index_of(s, IndexKind::second_order, 0, 1).value);
      share.add(s.features.front().noise.noise_share);
      failed.add(s.features.front().failures.share());
      CHECK(s.features.front().no_indices.empty());
    }
    for (std::size_t j = 0; j < 3; ++j) {
      INFO((kind == NoiseKind::shared ? "shared" : "independent") << ", parameter " << j + 1);
      // Three standard errors of the mean of 16 studies, and 0.005 for the bias of a ratio.
      CHECK_THAT(first[j].mean(),
                 WithinAbs(ishigami_indices.first[j], 3.0 * first[j].standard_error() + 0.005));
      CHECK_THAT(total[j].mean(),
                 WithinAbs(ishigami_indices.total[j], 3.0 * total[j].standard_error() + 0.005));
      CHECK(first[j].standard_error() < 0.02);  // else the line above would say nothing
      CHECK(total[j].standard_error() < 0.02);
    }
    // A packing shared by a row must not look like an interaction.
    CHECK_THAT(pair.mean(), WithinAbs(0.0, 3.0 * pair.standard_error() + 0.005));
    CHECK(pair.standard_error() < 0.04);
    CHECK_THAT(share.mean(), WithinAbs(0.2, 3.0 * share.standard_error() + 0.005));
    CHECK_THAT(failed.mean(), WithinAbs(0.05, 3.0 * failed.standard_error() + 0.002));
  }
}

TEST_CASE("Sobol: noise left uncorrected would be far outside the bars",
          "[calibrate][sensitivity]") {
  // One packing: nothing is measured, so nothing is taken out, and the report has to say so.
  const double sd = std::sqrt(ishigami_variance / 4.0);
  const SensitivitySummary s =
      sobol_study(ishigami_parameters(), noisy(ishigami, sd, NoiseKind::independent),
                  study(SensitivityMethod::sobol, 4096, 1, 1));
  CHECK(std::isnan(s.features.front().noise.noise_share));
  // S / 1.25 and (ST + 0.25) / 1.25.
  CHECK_THAT(index_of(s, IndexKind::first_order, 1).value, WithinAbs(0.354, 0.04));
  CHECK_THAT(index_of(s, IndexKind::total, 2).value, WithinAbs(0.395, 0.04));
}

TEST_CASE("Sobol: failures in a region are noticed, named and bounded",
          "[calibrate][sensitivity]") {
  const SensitivitySummary s = sobol_study(
      ishigami_parameters(), failing(noisy(ishigami, 1.0, NoiseKind::shared), in_a_corner),
      study(SensitivityMethod::sobol, 512));
  const FeatureSensitivity& f = s.features.front();
  CHECK_THAT(f.failures.share(), WithinAbs(0.05, 0.005));
  CHECK(f.failures.verdict == FailureVerdict::concentrated);
  CHECK(f.failures.parameters[0].p_value < 1e-6);
  CHECK(f.failures.parameters[1].p_value > 0.01);
  CHECK(f.failures.parameters[2].p_value > 0.01);
  CHECK_THAT(f.failures.parameters[0].shares[2], WithinAbs(0.15, 0.01));
  CHECK(f.failures.parameters[0].shares[0] == 0.0);
  for (std::size_t j = 0; j < 3; ++j) {
    const IndexEstimate first = index_of(s, IndexKind::first_order, j);
    const IndexEstimate total = index_of(s, IndexKind::total, j);
    // 0.05: sampling error of 512 rows, which the bounds are not about.
    CHECK(first.bound_low - 0.05 < ishigami_indices.first[j]);
    CHECK(first.bound_high + 0.05 > ishigami_indices.first[j]);
    CHECK(total.bound_low - 0.05 < ishigami_indices.total[j]);
    CHECK(total.bound_high + 0.05 > ishigami_indices.total[j]);
    CHECK(total.bound_high - total.bound_low < 0.5);  // or they would say nothing
  }
}

TEST_CASE("Sobol: bounds contain what the completed runs alone get wrong",
          "[calibrate][sensitivity]") {
  // x1 matters most where the runs fail: without them ST_1 is 0.70 instead of 0.93.
  const auto edge = [](const Eigen::VectorXd& x) { return x[1] + 4.0 * std::pow(x[0], 4); };
  const auto at_the_edge = [](const Eigen::VectorXd& x) { return x[0] > 0.8; };
  const SensitivitySummary cut = sobol_study(
      unit_parameters(2), failing(noisy(edge, 0.1, NoiseKind::independent), at_the_edge),
      study(SensitivityMethod::sobol, 256));
  const double of_x1 = 16.0 * (1.0 / 9.0 - 1.0 / 25.0);
  const double truth = of_x1 / (of_x1 + 1.0 / 12.0);
  const IndexEstimate found = index_of(cut, IndexKind::total, 0);
  CHECK(found.high95 < truth);  // the interval is about sampling, not about what is missing
  CHECK(found.bound_low <= truth);
  CHECK(found.bound_high >= truth);
}

TEST_CASE("Sobol: random failures are called so, a handful is called too few",
          "[calibrate][sensitivity]") {
  const auto verdict = [](std::uint64_t one_in, int rows) {
    const auto fails = [one_in](const Eigen::VectorXd& x) { return word_of(x) % one_in == 0; };
    return sobol_study(ishigami_parameters(), failing(simulator_of(one_output(ishigami)), fails),
                       study(SensitivityMethod::sobol, rows))
        .features.front()
        .failures;
  };
  CHECK(verdict(20, 256).verdict == FailureVerdict::no_pattern);
  const FailurePattern few = verdict(100, 32);
  REQUIRE(few.num_failed > 0);
  REQUIRE(few.num_failed < min_failures_for_a_pattern);
  CHECK(few.verdict == FailureVerdict::too_few);
}

TEST_CASE("Failures: random ones are called concentrated as often as the test's level",
          "[calibrate][sensitivity]") {
  std::vector<SampleRow> rows = {};
  int num_called = 0;
  const int num_studies = 300;
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(num_studies); ++k) {
    rows.assign(64, {});
    Eigen::MatrixXd is_failed(4, 64);
    const Eigen::MatrixXd u = nested_points(64 * 4, 3, k);
    for (Eigen::Index r = 0; r < 64; ++r) {
      rows[static_cast<std::size_t>(r)].unit = u.middleCols(4 * r, 4);
      for (Eigen::Index i = 0; i < 4; ++i)
        is_failed(i, r) = scrambled(k * 1000 + static_cast<std::uint64_t>(4 * r + i)) % 10 == 0;
    }
    num_called += failure_pattern(rows, is_failed).verdict == FailureVerdict::concentrated ? 1 : 0;
  }
  // 5 % at most by Bonferroni; +3 standard deviations of a binomial.
  CHECK(num_called <= num_studies * 0.05 + 3.0 * std::sqrt(num_studies * 0.05 * 0.95));
}
