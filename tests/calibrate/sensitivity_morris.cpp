// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "calibrate/morris.hpp"
#include "tests/calibrate/sensitivity_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// Every start on the grid with every order of the three parameters.
std::vector<SampleRow> all_trajectories(int levels) {
  std::vector<SampleRow> rows;
  for (int a = 0; a < levels; ++a)
    for (int b = 0; b < levels; ++b)
      for (int c = 0; c < levels; ++c) {
        std::vector<int> order = {0, 1, 2};
        do {
          rows.emplace_back().unit = morris_trajectory(std::vector<int>{a, b, c}, order, levels);
        } while (std::ranges::next_permutation(order).found);
      }
  return rows;
}

RowOutputs ishigami_of(const std::vector<SampleRow>& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  RowOutputs out{Eigen::MatrixXd(4, n),
                 Eigen::MatrixXd::Constant(2, n, std::numeric_limits<double>::quiet_NaN())};
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index i = 0; i < 4; ++i)
      out.values(i, r) = ishigami(
          physical_point(ishigami_parameters(), rows[static_cast<std::size_t>(r)].unit.col(i)));
  return out;
}

struct GridCase {
  int levels;
  std::vector<double> mu_star;
};

SensitivitySummary morris_study(int num_rows, const Simulator& simulator, int packings = 8) {
  return run_sensitivity(ishigami_parameters(), {plain_target("y")}, simulator,
                         study(SensitivityMethod::morris, num_rows, 1, packings));
}

}  // namespace

TEST_CASE("Morris: all trajectories of a grid give its exact effects", "[calibrate][sensitivity]") {
  // Exact values by enumeration of the grid: Ishigami, effects per unit of the unit cube.
  const std::vector<GridCase> cases = {{4, {7.704054, 7.875, 6.248796}},
                                       {6, {7.989961, 2.687156, 5.542865}},
                                       {8, {7.959193, 3.230809, 5.723541}},
                                       {10, {7.903377, 2.287161, 5.383394}}};
  for (const GridCase& c : cases) {
    const std::vector<SampleRow> rows = all_trajectories(c.levels);
    const Eigen::VectorXd found =
        estimate(morris_terms(rows, ishigami_of(rows)), morris_statistic(3, c.levels, 1));
    for (Eigen::Index j = 0; j < 3; ++j) {
      INFO(c.levels << " levels, parameter " << j + 1);
      // 1e-6: the last printed digit.
      CHECK_THAT(found[3 + j], WithinAbs(c.mu_star[static_cast<std::size_t>(j)], 1e-6));
    }
    if (c.levels != 4) continue;
    const double n = static_cast<double>(rows.size());
    const double to_population = std::sqrt((n - 1) / n);  // the printed sigma divides by n
    const std::vector<double> mu = {7.704054, 0.0, 0.0};
    const std::vector<double> sigma = {6.248796, 7.875, 8.837132};
    for (Eigen::Index j = 0; j < 3; ++j) {
      CHECK_THAT(found[j], WithinAbs(mu[static_cast<std::size_t>(j)], 1e-6));
      CHECK_THAT(found[6 + j] * to_population, WithinAbs(sigma[static_cast<std::size_t>(j)], 1e-6));
    }
  }
}

TEST_CASE("Morris: mu_star of Ishigami's second input is 7.875 for any trajectories on 4 levels",
          "[calibrate][sensitivity]") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SensitivityOptions options = study(SensitivityMethod::morris, 6, seed);
    const SensitivitySummary s = run_sensitivity(ishigami_parameters(), {plain_target("y")},
                                                 simulator_of(one_output(ishigami)), options);
    CHECK_THAT(index_of(s, IndexKind::mu_star, 1).value, WithinRel(7.875, 1e-12));
    CHECK(s.features.front().noise_floor == 0.0);
  }
}

TEST_CASE("Morris: a linear function gives its slopes and no sigma, whatever the packing adds",
          "[calibrate][sensitivity]") {
  const auto linear = [](const Eigen::VectorXd& x) { return 2.0 * x[0] - 3.0 * x[1]; };
  const SensitivitySummary s =
      run_sensitivity(unit_parameters(2), {plain_target("y")},
                      noisy(linear, 5.0, NoiseKind::shared), study(SensitivityMethod::morris, 8));
  // To rounding: a packing's shift is in no difference.
  CHECK_THAT(index_of(s, IndexKind::mu, 0).value, WithinRel(2.0, 1e-12));
  CHECK_THAT(index_of(s, IndexKind::mu, 1).value, WithinRel(-3.0, 1e-12));
  CHECK_THAT(index_of(s, IndexKind::mu_star, 1).value, WithinRel(3.0, 1e-12));
  CHECK_THAT(index_of(s, IndexKind::sigma, 1).value, WithinAbs(0.0, 1e-6));
  CHECK(s.features.front().noise.shared > 0.0);
  CHECK_THAT(s.features.front().noise_floor, WithinAbs(0.0, 1e-6));
}

TEST_CASE("Morris: noise of single runs is taken out of sigma and shown as a floor of mu_star",
          "[calibrate][sensitivity]") {
  const auto flat_in_second = [](const Eigen::VectorXd& x) { return 2.0 * x[0]; };
  const double sd = 0.5;
  // A fine grid: on 4 levels there are 16 points, and a run made twice has the same noise.
  SensitivityOptions options = study(SensitivityMethod::morris, 4000);
  options.levels = 100;
  const SensitivitySummary s =
      run_sensitivity(unit_parameters(2), {plain_target("y")},
                      noisy(flat_in_second, sd, NoiseKind::independent), options);
  const FeatureSensitivity& f = s.features.front();
  // Variance of v from 4000 squared differences: relative sd sqrt(2 / 4000) = 2.2 %; 4 sd.
  CHECK_THAT(f.noise.shared + f.noise.independent, WithinRel(sd * sd, 0.09));
  // mu_star of a parameter that does nothing is the floor: sd of |d| / sqrt(n) = 1 %, of v 1 %.
  CHECK_THAT(index_of(s, IndexKind::mu_star, 1).value, WithinRel(f.noise_floor, 0.06));
  CHECK_THAT(f.noise_floor,
             WithinRel(2.0 * sd * 198.0 / 100.0 / std::sqrt(std::numbers::pi), 0.05));
  // sd(d) = sqrt(2) sd / delta = 1.4 before the correction, 0 +- sqrt(0.09 * 1.4^2) after.
  CHECK(index_of(s, IndexKind::sigma, 0).value < 0.42);
  CHECK(index_of(s, IndexKind::sigma, 1).value < 0.42);
}

TEST_CASE("Morris: an effect needs its own two runs and no others", "[calibrate][sensitivity]") {
  const auto linear = one_output([](const Eigen::VectorXd& x) { return 2.0 * x[0] - 3.0 * x[1]; });
  const auto unlucky = [](const Eigen::VectorXd& x) { return word_of(x) % 5 == 0; };
  const SensitivitySummary s =
      run_sensitivity(unit_parameters(2), {plain_target("y")},
                      failing(simulator_of(linear), unlucky), study(SensitivityMethod::morris, 40));
  CHECK(s.num_failed > 10);
  CHECK_THAT(index_of(s, IndexKind::mu, 0).value, WithinRel(2.0, 1e-12));
  CHECK_THAT(index_of(s, IndexKind::mu, 1).value, WithinRel(-3.0, 1e-12));
  CHECK(index_of(s, IndexKind::mu, 0).num_values < 40);
  CHECK(index_of(s, IndexKind::mu, 0).num_values > 20);  // 0.8^2 of 40
}

TEST_CASE("Morris: a study of one row more begins with the same rows", "[calibrate][sensitivity]") {
  const SensitivitySummary small = morris_study(7, simulator_of(one_output(ishigami)));
  const SensitivitySummary large = morris_study(20, simulator_of(one_output(ishigami)));
  REQUIRE(small.runs.size() < large.runs.size());
  for (std::size_t i = 0; i < small.runs.size(); ++i) {
    REQUIRE(small.runs[i].parameters == large.runs[i].parameters);
    REQUIRE(small.runs[i].seed == large.runs[i].seed);
    REQUIRE(small.runs[i].is_repeat == large.runs[i].is_repeat);
  }
}
