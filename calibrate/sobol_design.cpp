// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/sobol_design.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <random>
#include <vector>

namespace tilth {
namespace {

constexpr int num_bits = 32;
using Directions = std::array<std::uint32_t, num_bits>;

// One row of the table: primitive polynomial of this degree with inner coefficients `a`, and the
// first `degree` odd numbers m.
struct Row {
  int degree;
  std::uint32_t a;
  std::array<std::uint32_t, 6> m;
};

// Dimensions 2 to 16 of new-joe-kuo-6.21201.
constexpr std::array<Row, max_sobol_dimensions - 1> table = {{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
}};

Directions direction_numbers(int dimension) {
  Directions v{};
  if (dimension == 0) {
    for (int i = 0; i < num_bits; ++i) v[static_cast<std::size_t>(i)] = 1U << (num_bits - 1 - i);
    return v;
  }
  const Row& row = table[static_cast<std::size_t>(dimension - 1)];
  for (int i = 0; i < num_bits; ++i) {
    const auto at = [&v](int k) -> std::uint32_t& { return v[static_cast<std::size_t>(k)]; };
    if (i < row.degree) {
      at(i) = row.m[static_cast<std::size_t>(i)] << (num_bits - 1 - i);
      continue;
    }
    // v_i = v_{i-s} ^ (v_{i-s} >> s) ^ sum_k a_k v_{i-k}   (Joe & Kuo 2008, recurrence of m)
    at(i) = at(i - row.degree) ^ (at(i - row.degree) >> row.degree);
    for (int k = 1; k < row.degree; ++k) {
      if ((row.a >> (row.degree - 1 - k)) & 1U) at(i) ^= at(i - k);
    }
  }
  return v;
}

// The integers k of the points k / 2^32 in one dimension.
std::vector<std::uint32_t> sobol_integers(int num_points, int dimension) {
  const Directions v = direction_numbers(dimension);
  std::vector<std::uint32_t> x(static_cast<std::size_t>(num_points), 0U);
  for (std::size_t i = 1; i < x.size(); ++i) {
    x[i] = x[i - 1] ^ v[static_cast<std::size_t>(std::countr_zero(i))];
  }
  return x;
}

constexpr double cell = 0x1p-32;

}  // namespace

Eigen::MatrixXd sobol_points(int num_points, int num_dimensions) {
  assert(num_dimensions >= 1 && num_dimensions <= max_sobol_dimensions && num_points >= 0);
  Eigen::MatrixXd points(num_dimensions, num_points);
  for (int d = 0; d < num_dimensions; ++d) {
    const std::vector<std::uint32_t> x = sobol_integers(num_points, d);
    for (int i = 0; i < num_points; ++i) points(d, i) = x[static_cast<std::size_t>(i)] * cell;
  }
  return points;
}

Eigen::MatrixXd shifted_sobol_points(int num_points, int num_dimensions, std::uint64_t seed) {
  assert(num_dimensions >= 1 && num_dimensions <= max_sobol_dimensions && num_points >= 0);
  std::mt19937_64 rng(seed);
  Eigen::MatrixXd points(num_dimensions, num_points);
  for (int d = 0; d < num_dimensions; ++d) {
    const auto shift = static_cast<std::uint32_t>(rng() >> 32);
    const std::vector<std::uint32_t> x = sobol_integers(num_points, d);
    for (int i = 0; i < num_points; ++i) {
      points(d, i) = ((x[static_cast<std::size_t>(i)] ^ shift) + 0.5) * cell;
    }
  }
  return points;
}

}  // namespace tilth
