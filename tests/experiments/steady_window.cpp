// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Steady part of a series and the standard error of a correlated mean.
#include "experiments/steady_window.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "dem_core/packing.hpp"

using namespace tilth;
using Catch::Matchers::WithinRel;

namespace {

constexpr std::size_t length = 2000;

double normal(std::mt19937_64& rng) {
  double sum = -6.0;
  for (int k = 0; k < 12; ++k) sum += uniform01(rng);
  return sum;
}

/// x_t = phi x_t-1 + noise of variance 1, begun in its stationary state.
std::vector<double> autoregression(double phi, std::mt19937_64& rng) {
  std::vector<double> x = {normal(rng) / std::sqrt(1 - phi * phi)};
  while (x.size() < length) x.push_back(phi * x.back() + normal(rng));
  return x;
}

}  // namespace

TEST_CASE("steady window: the standard error of an autoregression is that of its closed form",
          "[experiments][steady]") {
  for (const double phi : {0.0, 0.5, 0.9}) {
    std::mt19937_64 rng(7);
    double mean_error = 0.0, mean_square = 0.0;
    constexpr int repeats = 200;
    for (int k = 0; k < repeats; ++k) {
      const MeanWithError m = mean_with_error(autoregression(phi, rng));
      mean_error += m.standard_error / repeats;
      mean_square += m.mean * m.mean / repeats;
    }
    // var(mean) -> 1 / (1 - phi)^2 / n
    const double expected = 1 / (1 - phi) / std::sqrt(static_cast<double>(length));
    CAPTURE(phi, mean_error, expected);
    // 5 %: Geyer's cut of the noisy tail leaves a bias of 1-3 % at this length
    CHECK_THAT(mean_error, WithinRel(expected, 0.05));
    // 200 repeats know the scatter of the mean to 1 / sqrt(2 x 200) = 5 %; three of that
    CHECK_THAT(std::sqrt(mean_square), WithinRel(expected, 0.15));
  }
}

TEST_CASE("steady window: independent values are worth themselves, constants are sure",
          "[experiments][steady]") {
  const MeanWithError constant = mean_with_error(std::vector<double>(10, 3.0));
  CHECK(constant.mean == 3.0);
  CHECK(constant.standard_error == 0.0);
  CHECK(std::isnan(mean_with_error(std::vector<double>{1, 2}).standard_error));
  std::vector<double> ramp;
  for (int k = 0; k < 100; ++k) ramp.push_back(k);
  CHECK(mean_with_error(ramp).num_independent < 10);  // a trend is worth next to nothing
}

TEST_CASE("steady window: transients at both ends are left out, noise alone is not",
          "[experiments][steady]") {
  std::mt19937_64 rng(3);
  std::vector<double> x;
  for (std::size_t k = 0; k < length; ++k) {
    double level = 100;
    if (k < 300) level *= static_cast<double>(k) / 300;                        // comes in
    if (k >= 1800) level *= 1 + 2 * (static_cast<double>(k) - 1800) / 200;     // meets the end
    x.push_back(level + normal(rng));
  }
  const std::size_t block = 20;
  const Window w = steady_window(x, block);
  // A spoiled block is off by 3 to 7 sigma of a block's mean; up to five good ones may go with it,
  // since the rule takes a quiet rest for a good one.
  CHECK(w.begin >= 300 - block);
  CHECK(w.begin <= 300 + 5 * block);
  CHECK(w.end >= 1800 - 5 * block);
  CHECK(w.end <= 1800 + block);
  std::vector<double> noise;
  for (std::size_t k = 0; k < length; ++k) noise.push_back(normal(rng));
  CHECK(10 * steady_window(noise, block).size() > 7 * length);
  CHECK(steady_window({x.data(), 5}, 1).size() == 5);
}
