// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/sobol_indices.hpp"

#include <limits>

namespace tilth {
namespace {

// Position of the pair (j, k), j < k, among all pairs of d parameters.
Eigen::Index pair_id(Eigen::Index j, Eigen::Index k, Eigen::Index d) {
  return j * d - j * (j + 1) / 2 + k - j - 1;
}

// The runs of one row, centred.
struct CentredRow {
  const Eigen::VectorXd y;
  Eigen::Index d = (y.size() - 2) / 2;
  double a() const { return y[0]; }
  double b() const { return y[y.size() - 1]; }
  double ab(Eigen::Index j) const { return y[1 + j]; }
  double ba(Eigen::Index j) const { return y[1 + d + j]; }
};

void add_row_terms(const CentredRow& row, Eigen::Index r, RowTerms& terms) {
  const auto half_square = [](double x) { return 0.5 * x * x; };
  const Eigen::Index first = num_noise_terms;
  const Eigen::Index total = first + row.d;
  const Eigen::Index pairs = total + row.d;
  for (Eigen::Index j = 0; j < row.d; ++j) {
    terms.add(first + j, r, row.b() * (row.ab(j) - row.a()));
    terms.add(first + j, r, row.a() * (row.ba(j) - row.b()));
    terms.add(total + j, r, half_square(row.a() - row.ab(j)));
    terms.add(total + j, r, half_square(row.b() - row.ba(j)));
    for (Eigen::Index k = j + 1; k < row.d; ++k) {
      const Eigen::Index pair = pairs + pair_id(j, k, row.d);
      terms.add(pair, r, row.ba(j) * row.ab(k) - row.a() * row.b());
      terms.add(pair, r, row.ba(k) * row.ab(j) - row.a() * row.b());
    }
  }
}

}  // namespace

Eigen::Index num_saltelli_points(int num_free) { return 2 * num_free + 2; }

std::vector<SampleRow> saltelli_rows(int num_rows, int num_free, std::uint64_t seed) {
  const Eigen::Index d = num_free;
  const Eigen::MatrixXd points = nested_points(num_rows, 2 * num_free, seed);
  std::vector<SampleRow> rows(static_cast<std::size_t>(num_rows));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Eigen::VectorXd a = points.col(static_cast<Eigen::Index>(r)).head(d);
    const Eigen::VectorXd b = points.col(static_cast<Eigen::Index>(r)).tail(d);
    Eigen::MatrixXd& unit = rows[r].unit;
    unit.resize(d, num_saltelli_points(num_free));
    unit.leftCols(1 + d).colwise() = a;
    unit.rightCols(1 + d).colwise() = b;
    for (Eigen::Index j = 0; j < d; ++j) {
      unit(j, 1 + j) = b[j];
      unit(j, 1 + d + j) = a[j];
    }
  }
  return rows;
}

std::vector<SampleRow> saltelli_base_rows(int num_rows, int num_free, std::uint64_t seed) {
  const Eigen::MatrixXd points = nested_points(num_rows, 2 * num_free, seed);
  std::vector<SampleRow> rows(static_cast<std::size_t>(num_rows));
  for (std::size_t r = 0; r < rows.size(); ++r)
    rows[r].unit = points.col(static_cast<Eigen::Index>(r)).head(num_free);
  return rows;
}

RowTerms sobol_terms(const RowOutputs& outputs) {
  const Eigen::Index d = (outputs.values.rows() - 2) / 2;
  const double centre = centre_of(outputs);
  RowTerms terms(num_noise_terms + 2 * d + d * (d - 1) / 2, outputs.values.cols());
  add_noise_terms(outputs, centre, terms);
  for (Eigen::Index r = 0; r < outputs.values.cols(); ++r)
    add_row_terms({outputs.values.col(r).array() - centre}, r, terms);
  return terms;
}

RowStatistic sobol_statistic(int num_free, int num_packings) {
  return [=](const Eigen::VectorXd& means, const Eigen::VectorXd& counts) {
    const Eigen::Index d = num_free;
    const Eigen::Index num_pairs = d * (d - 1) / 2;
    const NoiseSplit noise = noise_split(means, counts, num_packings);
    Eigen::VectorXd result(2 * d + num_pairs + 1);
    result.head(2 * d + num_pairs) = means.tail(2 * d + num_pairs);
    result.segment(d, d).array() -= noise.independent;
    result /= noise.parameters > 0 ? noise.parameters : std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index j = 0; j < d; ++j)
      for (Eigen::Index k = j + 1; k < d; ++k)
        result[2 * d + pair_id(j, k, d)] -= result[j] + result[k];
    result[2 * d + num_pairs] = noise.noise_share;
    return result;
  };
}

std::vector<IndexEstimate> sobol_index_list(std::size_t num_free) {
  std::vector<IndexEstimate> list;
  for (const IndexKind kind : {IndexKind::first_order, IndexKind::total})
    for (std::size_t j = 0; j < num_free; ++j) list.push_back({kind, j, j});
  for (std::size_t j = 0; j < num_free; ++j)
    for (std::size_t k = j + 1; k < num_free; ++k) list.push_back({IndexKind::second_order, j, k});
  return list;
}

}  // namespace tilth
