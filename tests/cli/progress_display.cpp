// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "calibrate/cli/progress_display.hpp"

using namespace tilth;

TEST_CASE("Progress: clock texts", "[cli][progress]") {
  CHECK(clock_text(-1) == "0:00");
  CHECK(clock_text(59.6) == "1:00");
  CHECK(clock_text(65) == "1:05");
  CHECK(clock_text(3723) == "1:02:03");
}

TEST_CASE("Progress: a line tells stage, counts and time left", "[cli][progress]") {
  CHECK(progress_line({"design", 10, 40}, 20) ==
        "design: 10 of about 40 simulations, 0:20 elapsed, about 1:00 left");
  CHECK(progress_line({"design", 0, 40}, 2) ==
        "design: 0 of about 40 simulations, 0:02 elapsed");
  // More done than expected: the estimate was wrong, the line is not.
  CHECK(progress_line({"fresh seeds", 50, 40}, 20) ==
        "fresh seeds: 50 of about 50 simulations, 0:20 elapsed, about 0:00 left");
}

TEST_CASE("Progress: one plain line per stage", "[cli][progress]") {
  std::vector<std::string> lines;
  ProgressDisplay display(false, [&](const std::string& line) { lines.push_back(line); });
  for (std::size_t k = 1; k <= 3; ++k) display.show({"design", k, 9});
  display.show({"search", 4, 9});
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].starts_with("design: 1 of"));
  CHECK(lines[1].starts_with("search: 4 of"));
}
