// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "calibrate/sobol_indices.hpp"
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

struct GCase {
  std::vector<double> a;
  double variance;
  ExactIndices exact;
};

}  // namespace

TEST_CASE("Sobol: Ishigami's indices lie within three standard errors of the exact ones",
          "[calibrate][sensitivity]") {
  const int n = 16384;
  const SensitivitySummary s =
      sobol_study(ishigami_parameters(), simulator_of(one_output(ishigami)),
                  study(SensitivityMethod::sobol, n));
  // Variances of the estimates at n = 1e5 independent rows, as another program documents them.
  const std::vector<double> first_variance = {1.985e-5, 1.693e-5, 2.504e-5};
  const std::vector<double> total_variance = {2.830e-5, 2.464e-5, 2.598e-5};
  const auto bar = [n](double variance) { return 3.0 * std::sqrt(variance * 1e5 / n); };
  for (std::size_t j = 0; j < 3; ++j) {
    CHECK_THAT(index_of(s, IndexKind::first_order, j).value,
               WithinAbs(ishigami_indices.first[j], bar(first_variance[j])));
    CHECK_THAT(index_of(s, IndexKind::total, j).value,
               WithinAbs(ishigami_indices.total[j], bar(total_variance[j])));
  }
  // 0.03: three standard errors of a difference of three such estimates.
  CHECK_THAT(index_of(s, IndexKind::second_order, 0, 2).value, WithinAbs(ishigami_s13, 0.03));
  CHECK_THAT(index_of(s, IndexKind::second_order, 0, 1).value, WithinAbs(0.0, 0.03));
  CHECK_THAT(index_of(s, IndexKind::second_order, 1, 2).value, WithinAbs(0.0, 0.03));
  CHECK_THAT(s.features.front().noise.parameters, WithinRel(ishigami_variance, 0.02));
  CHECK(s.features.front().noise.noise_share == 0.0);
}

TEST_CASE("Sobol: the g function's indices, four sets of coefficients",
          "[calibrate][sensitivity]") {
  const std::vector<GCase> cases = {
      {{0, 1, 4.5, 9, 99, 99, 99, 99},
       0.4654244319,
       {{0.7161921689, 0.1790480422, 0.02367577418, 0.007161921689, 7.1619e-5, 7.1619e-5, 7.1619e-5,
         7.1619e-5},
        {0.7871441267, 0.2421981928, 0.03431691015, 0.01046038707, 1.0494905e-4, 1.0494905e-4,
         1.0494905e-4, 1.0494905e-4}}},
      {{0, .5, 3, 9, 99, 99},
       0.5680709252,
       {{0.5867811898, 0.2607916399, 0.03667382436, 0.005867811898, 5.8678e-5, 5.8678e-5},
        {0.6900858923, 0.3561733638, 0.05633354223, 0.009170576642, 9.20084e-5, 9.20084e-5}}},
      {{78, 12, .5, 2, 97, 33},
       0.1934697868,
       {{0.000276065, 0.010194804, 0.765743068, 0.191435767, 0.000179396, 0.001490417},
        {0.000329458, 0.012143240, 0.795969769, 0.220313061, 0.000214097, 0.001778255}}},
      {{0, 1, 2, 4, 8},
       0.5241615156,
       {{0.6359362972, 0.1589840743, 0.07065958857, 0.02543745189, 0.007851065397},
        {0.7269522229, 0.223677607, 0.1038503176, 0.03826064331, 0.01191724956}}}};
  for (const GCase& c : cases) {
    const auto g = [&c](const Eigen::VectorXd& x) { return g_function(x, c.a); };
    const SensitivitySummary s =
        sobol_study(unit_parameters(c.a.size()), simulator_of(one_output(g)),
                    study(SensitivityMethod::sobol, 4096));
    CHECK_THAT(s.features.front().noise.parameters, WithinRel(c.variance, 0.02));
    for (std::size_t j = 0; j < c.a.size(); ++j) {
      INFO("a = " << c.a[j]);
      // 0.02: less than a third of three standard errors of 4096 independent rows (0.07).
      CHECK_THAT(index_of(s, IndexKind::first_order, j).value, WithinAbs(c.exact.first[j], 0.02));
      CHECK_THAT(index_of(s, IndexKind::total, j).value, WithinAbs(c.exact.total[j], 0.02));
    }
  }
}

TEST_CASE("Sobol: the g function's second-order indices", "[calibrate][sensitivity]") {
  const std::vector<double> a = {0, .5, 3, 9, 99, 99};
  const auto g = [&a](const Eigen::VectorXd& x) { return g_function(x, a); };
  const SensitivitySummary s = sobol_study(unit_parameters(6), simulator_of(one_output(g)),
                                           study(SensitivityMethod::sobol, 8192));
  const auto pair = [&](std::size_t j, std::size_t k) {
    return index_of(s, IndexKind::second_order, j, k).value;
  };
  // 0.001: the scatter measured over ten design seeds is 0.0002.
  CHECK_THAT(pair(0, 1), WithinAbs(0.0869305, 0.001));
  CHECK_THAT(pair(0, 2), WithinAbs(0.0122246, 0.001));
  CHECK_THAT(pair(0, 3), WithinAbs(0.00195594, 0.001));
  CHECK_THAT(pair(1, 2), WithinAbs(0.00543316, 0.001));
  CHECK_THAT(pair(1, 3), WithinAbs(0.000869305, 0.001));
  CHECK_THAT(pair(2, 3), WithinAbs(0.000122246, 0.001));
}

TEST_CASE("Sobol: a study of more rows begins with the same runs on the same packings",
          "[calibrate][sensitivity]") {
  // Nine parameters need 18 coordinates, beyond the Sobol table: those points are random.
  for (const std::size_t d : {std::size_t{3}, std::size_t{9}}) {
    const auto sum = one_output([](const Eigen::VectorXd& x) { return x.sum(); });
    const auto runs_of = [&](SensitivityMethod method, int n) {
      return sobol_study(unit_parameters(d), simulator_of(sum), study(method, n)).runs;
    };
    const auto small = runs_of(SensitivityMethod::sobol, 32);
    const auto large = runs_of(SensitivityMethod::sobol, 64);
    for (std::size_t i = 0; i < small.size(); ++i) {
      REQUIRE(small[i].parameters == large[i].parameters);
      REQUIRE(small[i].seed == large[i].seed);
      REQUIRE(small[i].row == large[i].row);
    }
    // The emulator's points are the first of each row.
    const auto single = runs_of(SensitivityMethod::emulator, 32);
    REQUIRE(single.front().parameters == small.front().parameters);
    REQUIRE(single.front().seed == small.front().seed);
  }
}

TEST_CASE("Sobol: packings are used evenly and are not tied to a half of the cube",
          "[calibrate][sensitivity]") {
  std::vector<SampleRow> rows = saltelli_rows(256, 3, 1);
  assign_packings(rows, {10, 4});
  for (std::uint64_t seed = 10; seed < 14; ++seed) {
    int num_rows = 0, num_low = 0, num_repeats = 0;
    for (const SampleRow& row : rows) {
      if (row.seed != seed) continue;
      ++num_rows;
      num_low += row.unit(0, 0) < 0.5 ? 1 : 0;
      num_repeats += row.repeat_seed ? 1 : 0;
      if (row.repeat_seed) REQUIRE(*row.repeat_seed != row.seed);
    }
    CHECK(num_rows == 64);
    // Fair coins, 64 of them: four standard deviations.
    CHECK(std::abs(num_low - 32) <= 16);
    CHECK(std::abs(num_repeats - 32) <= 16);
  }
}

TEST_CASE("Sobol: the same study gives the same bits", "[calibrate][sensitivity]") {
  const auto once = [] {
    return sobol_study(ishigami_parameters(), noisy(ishigami, 1.0, NoiseKind::independent),
                       study(SensitivityMethod::sobol, 64));
  };
  const SensitivitySummary a = once(), b = once();
  for (std::size_t i = 0; i < a.features.front().indices.size(); ++i) {
    REQUIRE(a.features.front().indices[i].value == b.features.front().indices[i].value);
    REQUIRE(a.features.front().indices[i].low95 == b.features.front().indices[i].low95);
  }
}
