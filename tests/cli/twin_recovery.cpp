// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Does a fit of the grains find what made the data, and do its intervals say how well?
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <iostream>
#include <thread>

#include "tests/support/twin.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

int all_threads() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

// The stages an interval depends on, as small as they may be.
FitOptions small_fit() {
  FitOptions options;
  options.num_design = 7;  // with the start values one full pack of eight
  options.num_noise_seeds = 4;
  options.num_search_seeds = 1;
  options.num_fresh_seeds = 3;
  options.num_rounds = 1;
  options.round_size = 4;
  options.num_starts = 1;
  options.max_iterations = 5;
  options.chi_square_tolerance = 0.1;
  return options;
}

}  // namespace

TEST_CASE("Twins: a small fit finds the parameters that made its data", "[cli][twin]") {
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, all_threads()};
  const TwinResult twin =
      run_twin({.truth = {6e6, 8e3, 0.6}, .noise_stream = 2, .options = small_fit()}, context);
  INFO(twin_table("small", twin));
  REQUIRE(twin.summary.is_usable());
  // Residuals first: 6 targets less 3 parameters leave 3 degrees of freedom. On fresh packings
  // the fit has adapted to nothing: 6 bound it. 99.9 %: crossed once in a thousand.
  CHECK(twin.summary.chi_square < chi_square_quantile(3.090, 3));
  CHECK(twin.summary.chi_square_fresh < chi_square_quantile(3.090, 6));
  CHECK(twin.summary.chi_square < 0.1 * twin.summary.chi_square_start);
  REQUIRE(twin.parameters.size() == 3);
  // 95 % of 3: two or more happens 99 times in 100, and the seeds are fixed.
  CHECK(twin.num_inside >= 2);
  // An interval that says nothing would hold the truth too. Two tests of four targets with sigma
  // 5 % and about 5 % of packing noise fix modulus and strength within a factor 1.5 either way.
  for (const TwinParameter& p : twin.parameters) {
    INFO(p.name << " " << p.lo95 << " to " << p.hi95);
    if (p.name != "friction") CHECK(p.hi95 / p.lo95 < 2.25);
  }
}

TEST_CASE("Twins: intervals hold the truth as often as they say", "[cli][twin][slow]") {
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, all_threads()};
  int num_inside = 0;
  int num_values = 0;
  int freedom = 0;
  double chi_square = 0.0;
  for (const TwinCase& c : documented_twins()) {
    const TwinResult twin = run_twin(c.spec, context);
    std::cout << twin_table(c.name, twin) << std::flush;
    CHECK(twin.summary.is_usable());
    num_inside += twin.num_inside;
    num_values += static_cast<int>(twin.parameters.size());
    chi_square += twin.summary.chi_square;
    freedom += static_cast<int>(twin.summary.num_observations - twin.summary.num_free);
  }
  std::cout << fmt::format("{} of {} true values inside; chi-square {:.1f} on {} degrees\n",
                           num_inside, num_values, chi_square, freedom);
  CHECK(10 * num_inside >= 8 * num_values);
  // 99.9 %: residuals end at the noise, packing noise included.
  CHECK(chi_square < chi_square_quantile(3.090, freedom));
}
