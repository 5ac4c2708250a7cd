// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Do the intervals of quick fits of the grains hold the truth 95 times in a hundred?
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <mutex>

#include "calibrate/parallel.hpp"
#include "calibrate/sobol_design.hpp"
#include "tests/support/binomial.hpp"
#include "tests/support/twin.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

constexpr int num_twins = 40;

/// Truths spread over the middle of the box of data/soils/loamy_sand, where a fit can leave room on
/// both sides of them.
TwinSpec twin_at(const Eigen::VectorXd& unit, int k) {
  TwinSpec spec;
  spec.truth = {1.5e6 * std::pow(8e6 / 1.5e6, unit[0]), 3e3 * std::pow(5.0, unit[1]),
                0.25 + 0.5 * unit[2]};
  spec.noise_stream = 400 + static_cast<std::uint64_t>(k);
  spec.options = quick_fit_options();
  spec.options.seed = 1 + 7 * static_cast<std::uint64_t>(k);
  return spec;
}

}  // namespace

TEST_CASE("Twins: intervals of 40 quick fits of the grains pass an exact binomial test",
          "[cli][twin][slow]") {
  PackingStore packings(default_packing_folder());
  const RunContext one_thread{packings, 1};
  const Eigen::MatrixXd units = shifted_sobol_points(num_twins, 3, 11);
  std::array<int, 3> hits = {0, 0, 0};
  std::mutex mutex;
  parallel_for_each_index(num_twins, threads_or_all(0), [&](std::size_t k) {
    const TwinResult twin =
        run_twin(twin_at(units.col(static_cast<Eigen::Index>(k)), static_cast<int>(k)), one_thread);
    const std::lock_guard lock(mutex);
    std::cout << twin_table(fmt::format("{}", k), twin) << std::flush;
    for (std::size_t i = 0; i < twin.parameters.size(); ++i) hits[i] += twin.parameters[i].inside ? 1 : 0;
  });
  for (const int hit : hits) {
    INFO(hit << " of " << num_twins);
    // Three parameters, two sides: either bound is crossed by chance once in 120 times.
    CHECK(binomial_tail(hit, num_twins, 0.95) > 0.05 / 6);
  }
}
