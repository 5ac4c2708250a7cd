// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Twin experiments: does the 95 % interval contain the truth 95 times in a hundred?
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "calibrate/fit.hpp"
#include "tests/calibrate/formula_models.hpp"
#include "tests/support/binomial.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

// Only the stages an interval depends on.
FitOptions local_only() {
  FitOptions options;
  options.num_design = 0;
  options.num_rounds = 0;
  options.num_starts = 1;
  options.num_fresh_seeds = 0;
  return options;
}

constexpr int num_twins = 1000;
constexpr double sigma = 0.04;  // of the measurement
constexpr double noise = 0.05;  // of one packing

// How often each of the three parameters' intervals contains the truth.
std::array<int, 3> count_hits(bool noise_is_common) {
  std::array<int, 3> hits = {0, 0, 0};
  for (std::uint64_t stream = 1000; stream < 1000 + num_twins; ++stream) {
    const Simulator own = simulator_of(soil_formula, noise, stream);
    const Simulator common = [stream](const Eigen::MatrixXd& parameters,
                                              std::span<const std::uint64_t> seeds) {
      std::vector<Evaluation> runs = simulator_of(soil_formula)(parameters, seeds);
      for (std::size_t i = 0; i < runs.size(); ++i)
        runs[i].features *= std::exp(noise * normal_number(stream, seeds[i], 0));
      return runs;
    };
    const FitSummary summary = fit(soil_parameters(), soil_targets(sigma, stream),
                                   noise_is_common ? common : own, nullptr, local_only());
    if (!summary.is_usable()) continue;  // a missed twin is a missed truth
    for (std::size_t i = 0; i < 3; ++i) {
      const double truth = soil_truth()[static_cast<Eigen::Index>(i)];
      const FittedParameter& p = summary.parameters[i];
      hits[i] += p.lo95 <= truth && truth <= p.hi95 ? 1 : 0;
    }
  }
  return hits;
}

}  // namespace

TEST_CASE("Fit: 95 % intervals contain the truth as often as they say", "[calibrate][fit]") {
  for (const bool noise_is_common : {false, true}) {
    for (const int hit : count_hits(noise_is_common)) {
      INFO(hit << " of " << num_twins << (noise_is_common ? ", common noise" : ", own noise"));
      // Exact binomial: at 95 % coverage either bound is crossed once in 1000. With six noise
      // seeds the true coverage is 93-95 %, since the noise itself is only estimated.
      REQUIRE(binomial_cdf(hit, num_twins, 0.95) > 1e-3);
      REQUIRE(1.0 - binomial_cdf(hit - 1, num_twins, 0.95) > 1e-3);
    }
  }
}
