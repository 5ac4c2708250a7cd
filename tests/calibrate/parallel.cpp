// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/parallel.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

using namespace tilth;

TEST_CASE("Parallel: every index is visited exactly once at any number of threads",
          "[calibrate][parallel]") {
  for (const int num_threads : {1, 2}) {
    std::vector<std::atomic<int>> visits(1000);
    parallel_for_each_index(visits.size(), num_threads, [&](std::size_t i) { ++visits[i]; });
    for (const auto& count : visits) REQUIRE(count == 1);
    parallel_for_each_index(0, num_threads, [](std::size_t) { FAIL("no index to visit"); });
  }
}

TEST_CASE("Parallel: an exception of a body reaches the caller", "[calibrate][parallel]") {
  for (const int num_threads : {1, 2}) {
    const auto body = [](std::size_t i) {
      if (i == 7) throw std::runtime_error("seven");
    };
    REQUIRE_THROWS_WITH(parallel_for_each_index(20, num_threads, body), "seven");
  }
}
