// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Does a fit of the grains find what made the data, and do its intervals say how well?
#include <catch2/catch.hpp>
#include <chrono>
#include <fmt/format.h>
#include <iostream>
#include <thread>

#include "tests/support/twin.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

int all_threads() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The stages an interval depends on, as small as they may be.
FitOptions small_fit() {
  FitOptions options;
  options.num_design = 7;  // with the start values one full pack of eight
  options.num_noise_seeds = 5;
  options.num_search_seeds = 2;
  options.num_fresh_seeds = 3;
  options.num_rounds = 1;
  options.round_size = 4;
  options.num_starts = 1;
  options.max_iterations = 6;
  options.chi_square_tolerance = 0.1;
  return options;
}

}  // namespace

TEST_CASE("Twins: a small fit finds the parameters that made its data", "[cli][twin]") {
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, all_threads()};
  const TwinTruth truths[] = {{1.5e6, 3e3, 0.35}, {6e6, 8e3, 0.6}};
  int num_inside = 0;
  for (std::uint64_t k = 0; k < 2; ++k) {
    const TwinResult twin =
        run_twin({.truth = truths[k], .noise_stream = k + 1, .options = small_fit()}, context);
    INFO(twin_table(fmt::format("{}", k + 1), twin));
    REQUIRE(twin.summary.is_usable());
    // Residuals first: 6 targets less 3 parameters leave 3 degrees of freedom; on fresh packings
    // the fit has adapted to nothing, so that 6 bound it. 99.9 %: once in a thousand.
    CHECK(twin.summary.chi_square < chi_square_quantile(3.090, 3));
    CHECK(twin.summary.chi_square_fresh < chi_square_quantile(3.090, 6));
    CHECK(twin.summary.chi_square < twin.summary.chi_square_start);
    num_inside += twin.num_inside;
    REQUIRE(twin.parameters.size() == 3);
    for (const TwinParameter& p : twin.parameters) {
      // An interval that says nothing would hold the truth too.
      INFO(p.name << " " << p.lo95 << " to " << p.hi95);
      CHECK(p.hi95 / p.lo95 < 6.0);
    }
  }
  // 95 % of 6: five or more happens 97 times in 100, and the seeds are fixed.
  CHECK(num_inside >= 5);
}

TEST_CASE("Twins: intervals of the ordinary fit hold the truth", "[cli][twin][slow]") {
  PackingStore packings(default_packing_folder());
  const RunContext context{packings, all_threads()};
  struct Case {
    const char* name;
    TwinSpec spec;
  };
  FitOptions options;  // the program's own, but for the number of starts
  options.num_starts = 1;
  const Fidelity search = Fidelity::search;
  const Case cases[] = {
      {"soft, weak", {{1.5e6, 3e3, 0.35}, search, search, {}, 0.05, 0.026, false, 6, 11, options}},
      {"stiff, strong", {{8e6, 15e3, 0.6}, search, search, {}, 0.05, 0.026, false, 6, 12, options}},
      {"stiff, weak", {{6e6, 4e3, 0.25}, search, search, {}, 0.05, 0.026, false, 6, 13, options}},
      {"middle, line", {{3e6, 8e3, 0.45}, search, search, {}, 0.05, 0.026, true, 6, 14, options}},
      {"other size",
       {{3e6, 6e3, 0.4}, search, Fidelity::preview, search, 0.05, 0.026, false, 6, 15, options}},
  };
  int num_inside = 0;
  int num_values = 0;
  double chi_square = 0.0;
  int freedom = 0;
  for (const Case& c : cases) {
    const auto start = std::chrono::steady_clock::now();
    const TwinResult twin = run_twin(c.spec, context);
    std::cout << twin_table(c.name, twin) << fmt::format("({:.0f} s)\n", seconds_since(start))
              << std::flush;
    CHECK(twin.summary.is_usable());
    num_inside += twin.num_inside;
    num_values += static_cast<int>(twin.parameters.size());
    chi_square += twin.summary.chi_square;
    freedom += static_cast<int>(twin.summary.num_observations - twin.summary.num_free);
  }
  INFO(num_inside << " of " << num_values << ", chi-square " << chi_square << " of " << freedom);
  std::cout << fmt::format("{} of {} true values inside; chi-square {:.1f} on {} degrees\n",
                           num_inside, num_values, chi_square, freedom);
  CHECK(10 * num_inside >= 8 * num_values);
  // Neither worse nor better than the stated noise: 99 % either way.
  CHECK(chi_square < chi_square_quantile(2.326, freedom));
  CHECK(chi_square > chi_square_quantile(-2.326, freedom));
}
