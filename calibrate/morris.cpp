// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/morris.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace tilth {
namespace {

constexpr std::uint64_t stream_order = 11;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::vector<int> drawn_order(int num_free, std::uint64_t seed, std::uint64_t row) {
  std::vector<int> order(static_cast<std::size_t>(num_free));
  std::iota(order.begin(), order.end(), 0);
  const auto n = static_cast<std::uint64_t>(num_free);
  for (std::uint64_t k = n; k > 1; --k)
    std::swap(order[k - 1], order[design_word(seed, stream_order, row * n + k) % k]);
  return order;
}

// The parameter that changes between two neighbouring points, and by how much.
std::pair<Eigen::Index, double> step_between(const SampleRow& row, Eigen::Index point) {
  const Eigen::VectorXd change = row.unit.col(point + 1) - row.unit.col(point);
  Eigen::Index j = 0;
  change.cwiseAbs().maxCoeff(&j);
  return {j, change[j]};
}

}  // namespace

double morris_step(int levels) { return levels / (2.0 * (levels - 1)); }

Eigen::MatrixXd morris_trajectory(std::span<const int> start_levels, std::span<const int> order,
                                  int levels) {
  const auto d = static_cast<Eigen::Index>(start_levels.size());
  const auto unit_of = [levels](int level) { return static_cast<double>(level) / (levels - 1); };
  Eigen::MatrixXd unit(d, d + 1);
  for (Eigen::Index j = 0; j < d; ++j)
    unit.row(j).setConstant(unit_of(start_levels[static_cast<std::size_t>(j)]));
  for (Eigen::Index k = 0; k < d; ++k) {
    const int j = order[static_cast<std::size_t>(k)];
    const int from = start_levels[static_cast<std::size_t>(j)];
    const int to = from < levels / 2 ? from + levels / 2 : from - levels / 2;
    unit.row(j).tail(d - k).setConstant(unit_of(to));
  }
  return unit;
}

std::vector<SampleRow> morris_rows(int num_rows, int num_free, int levels, std::uint64_t seed) {
  const Eigen::MatrixXd starts = nested_points(num_rows, num_free, seed);
  std::vector<SampleRow> rows(static_cast<std::size_t>(num_rows));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<int> levels_of_start;
    for (const double u : starts.col(static_cast<Eigen::Index>(r)))
      levels_of_start.push_back(static_cast<int>(u * levels));
    rows[r].unit = morris_trajectory(levels_of_start, drawn_order(num_free, seed, r), levels);
  }
  return rows;
}

RowTerms morris_terms(const std::vector<SampleRow>& rows, const RowOutputs& outputs) {
  const Eigen::Index d = outputs.values.rows() - 1;
  RowTerms terms(num_noise_terms + 3 * d, outputs.values.cols());
  add_noise_terms(outputs, centre_of(outputs), terms);
  for (Eigen::Index r = 0; r < outputs.values.cols(); ++r) {
    for (Eigen::Index k = 0; k < d; ++k) {
      const auto [j, step] = step_between(rows[static_cast<std::size_t>(r)], k);
      const double effect = (outputs.values(k + 1, r) - outputs.values(k, r)) / step;
      terms.add(num_noise_terms + j, r, effect);
      terms.add(num_noise_terms + d + j, r, std::abs(effect));
      terms.add(num_noise_terms + 2 * d + j, r, effect * effect);
    }
  }
  return terms;
}

RowStatistic morris_statistic(int num_free, int levels, int num_packings) {
  return [=](const Eigen::VectorXd& means, const Eigen::VectorXd& counts) {
    const Eigen::Index d = num_free;
    const NoiseSplit noise = noise_split(means, counts, num_packings);
    const double delta = morris_step(levels);
    Eigen::VectorXd result(3 * d + 1);
    for (Eigen::Index j = 0; j < d; ++j) {
      const double n = counts[num_noise_terms + j];
      const double mu = means[num_noise_terms + j];
      const double square = means[num_noise_terms + 2 * d + j];
      const double variance =
          n > 1 ? (square - mu * mu) * n / (n - 1) - 2.0 * noise.independent / (delta * delta)
                : nan_value;
      result[j] = mu;
      result[d + j] = means[num_noise_terms + d + j];
      result[2 * d + j] = std::isnan(variance) ? nan_value : std::sqrt(std::max(0.0, variance));
    }
    result[3 * d] = noise.noise_share;
    return result;
  };
}

double morris_noise_floor(double independent_noise, int levels) {
  return 2.0 * std::sqrt(independent_noise / std::numbers::pi) / morris_step(levels);
}

std::vector<IndexEstimate> morris_index_list(std::size_t num_free) {
  std::vector<IndexEstimate> list;
  for (const IndexKind kind : {IndexKind::mu, IndexKind::mu_star, IndexKind::sigma})
    for (std::size_t j = 0; j < num_free; ++j) list.push_back({kind, j, j});
  return list;
}

}  // namespace tilth
