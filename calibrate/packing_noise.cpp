// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/packing_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tilth {
namespace {

enum : Eigen::Index { term_mean, term_square, term_noise, term_shared };

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

// Columns of the ends: one for rows of one point.
std::vector<Eigen::Index> ends_of(const RowOutputs& outputs) {
  const Eigen::Index last = outputs.values.rows() - 1;
  return last == 0 ? std::vector<Eigen::Index>{0} : std::vector<Eigen::Index>{0, last};
}

}  // namespace

double centre_of(const RowOutputs& outputs) {
  double sum = 0.0;
  int count = 0;
  for (const Eigen::Index end : ends_of(outputs)) {
    for (const double y : outputs.values.row(end)) {
      if (std::isnan(y)) continue;
      sum += y;
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

void add_noise_terms(const RowOutputs& outputs, double centre, RowTerms& terms) {
  const std::vector<Eigen::Index> ends = ends_of(outputs);
  for (Eigen::Index r = 0; r < outputs.values.cols(); ++r) {
    double product = 0.5;
    for (std::size_t e = 0; e < ends.size(); ++e) {
      const double y = outputs.values(ends[e], r);
      const double difference = y - outputs.repeats(static_cast<Eigen::Index>(e), r);
      terms.add(term_mean, r, y - centre);
      terms.add(term_square, r, (y - centre) * (y - centre));
      terms.add(term_noise, r, 0.5 * difference * difference);
      product *= difference;
    }
    terms.add(term_shared, r, ends.size() == 2 ? product : nan_value);
  }
}

NoiseSplit noise_split(const Eigen::VectorXd& means, const Eigen::VectorXd& counts,
                       int num_packings) {
  NoiseSplit split;
  const double n = counts[term_mean];
  split.mean = means[term_mean];
  split.total = n > 1 ? (means[term_square] - split.mean * split.mean) * n / (n - 1) : nan_value;
  split.parameters = split.total;
  split.noise_share = nan_value;
  if (counts[term_noise] < 1) return split;
  const double noise = means[term_noise];
  const double shared = counts[term_shared] > 0 ? means[term_shared] : 0.0;
  split.shared = std::clamp(shared, 0.0, noise);
  split.independent = noise - split.shared;
  split.parameters = split.total - split.independent - (1.0 - 1.0 / num_packings) * split.shared;
  split.noise_share = std::min(1.0, noise / (std::max(0.0, split.parameters) + noise));
  return split;
}

}  // namespace tilth
