// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/effective_sample_size.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

constexpr std::size_t length = 20000;

std::vector<double> autoregression(double phi, std::uint64_t stream) {
  std::vector<double> series;
  double value = normal_number(stream, 1, 0) / std::sqrt(1.0 - phi * phi);
  for (std::uint64_t i = 1; i <= length; ++i) {
    series.push_back(value);
    value = phi * value + normal_number(stream, 1, i);
  }
  return series;
}

}  // namespace

TEST_CASE("Effective sample size: a first-order autoregression is worth n (1 - phi) / (1 + phi)",
          "[calibrate][sample_size]") {
  for (const double phi : {0.0, 0.5, 0.9, 0.98}) {
    double mean = 0.0;
    for (std::uint64_t stream = 1; stream <= 8; ++stream)
      mean += effective_sample_size(autoregression(phi, stream)) / 8.0;
    INFO("phi = " << phi);
    // The estimate scatters by sqrt(2 lags / n): 14 % at phi = 0.98 and 400 lags, over 8 series 5
    // %.
    REQUIRE_THAT(mean, WithinRel(length * (1.0 - phi) / (1.0 + phi), phi < 0.95 ? 0.08 : 0.2));
  }
}

TEST_CASE("Effective sample size: never above n, never below 1", "[calibrate][sample_size]") {
  REQUIRE(effective_sample_size(std::vector<double>{}) == 0.0);
  REQUIRE(effective_sample_size(std::vector<double>(10, 3.0)) == 1.0);
  REQUIRE(effective_sample_size(autoregression(-0.8, 3)) == length);
  std::vector<double> ramp;
  for (int i = 0; i < 1000; ++i) ramp.push_back(i);
  REQUIRE(effective_sample_size(ramp) < 10.0);  // a trend is worth next to nothing
}
