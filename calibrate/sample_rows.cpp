// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/sample_rows.hpp"

#include <numeric>

#include "calibrate/sobol_design.hpp"

namespace tilth {
namespace {

// Streams of design_word().
enum : std::uint64_t {
  stream_points = 1,
  stream_packing = 2,
  stream_repeat = 3,
  stream_second = 4
};

std::uint64_t scrambled(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15ULL;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

// The packings of one block of rows, in an order of its own (Fisher and Yates).
std::vector<std::uint64_t> shuffled_packings(const PackingPlan& plan, std::uint64_t block) {
  const auto n = static_cast<std::uint64_t>(plan.num_packings);
  std::vector<std::uint64_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (std::uint64_t k = n; k > 1; --k)
    std::swap(order[k - 1], order[design_word(plan.first_seed, stream_packing, block * n + k) % k]);
  return order;
}

}  // namespace

std::uint64_t design_word(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return scrambled(scrambled(scrambled(stream) ^ seed) ^ index);
}

Eigen::MatrixXd nested_points(int num_points, int num_dimensions, std::uint64_t seed) {
  if (num_dimensions <= max_sobol_dimensions)
    return shifted_sobol_points(num_points, num_dimensions, seed);
  Eigen::MatrixXd points(num_dimensions, num_points);
  for (Eigen::Index i = 0; i < points.size(); ++i) {
    const std::uint64_t word = design_word(seed, stream_points, static_cast<std::uint64_t>(i));
    points.data()[i] = (static_cast<double>(word >> 11) + 0.5) * 0x1p-53;
  }
  return points;
}

void assign_packings(std::vector<SampleRow>& rows, const PackingPlan& plan) {
  const auto n = static_cast<std::uint64_t>(plan.num_packings);
  for (std::uint64_t r = 0; r < rows.size(); ++r) {
    const std::uint64_t packing = shuffled_packings(plan, r / n)[r % n];
    rows[r].seed = plan.first_seed + packing;
    const bool is_drawn = design_word(plan.first_seed, stream_repeat, r / 2) % 2 == r % 2;
    if (n < 2 || !is_drawn) continue;
    const std::uint64_t step = 1 + design_word(plan.first_seed, stream_second, r) % (n - 1);
    rows[r].repeat_seed = plan.first_seed + (packing + step) % n;
  }
}

}  // namespace tilth
