// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/scale_study.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibrate/student_t.hpp"

namespace tilth {
namespace {

constexpr double rounding = 1e-24;  ///< of a squared share: answers without scatter have weights too

/// Means and deviations of every size, finest first.
struct Scatter {
  std::vector<double> radius_m;
  std::vector<double> num_packings;
  std::vector<Eigen::VectorXd> mean;
  std::vector<std::vector<Eigen::VectorXd>> deviations;  // from the mean of their size
  double trace = 0.0;             // tr S
  double trace_of_square = 0.0;   // tr(S^2)
  double freedom = 0.0;

  double half_width_95() const { return student_t_half_width(0.95, static_cast<int>(freedom)); }
};

void check(std::span<const SizeAnswers> sizes, double tolerance) {
  if (sizes.size() < 2) throw std::invalid_argument("a scale study needs two sizes at least");
  if (!(tolerance > 0.0 && tolerance < 1.0))
    throw std::invalid_argument("the tolerance must lie between 0 and 1");
  const auto length = sizes.front().displacement_m.empty() ? 0 : sizes.front().displacement_m.front().size();
  for (const SizeAnswers& size : sizes) {
    if (size.displacement_m.size() < 2)
      throw std::invalid_argument("a scale study needs two packings of every size at least");
    for (const Eigen::VectorXd& u : size.displacement_m)
      if (u.size() != length || length == 0)
        throw std::invalid_argument("the sizes of a scale study must answer the same quantities");
  }
}

/// tr(S^2) from deviations of different sizes.
double trace_of_square(const Scatter& s) {
  double sum = 0.0, count = 0.0;
  for (std::size_t a = 0; a < s.deviations.size(); ++a)
    for (std::size_t b = a + 1; b < s.deviations.size(); ++b)
      for (const Eigen::VectorXd& i : s.deviations[a])
        for (const Eigen::VectorXd& j : s.deviations[b]) {
          const double product = i.dot(j);
          sum += product * product / ((1 - 1 / s.num_packings[a]) * (1 - 1 / s.num_packings[b]));
          ++count;
        }
  return sum / count;
}

Scatter scatter_of(std::span<const SizeAnswers> sizes) {
  std::vector<const SizeAnswers*> order;
  for (const SizeAnswers& size : sizes) order.push_back(&size);
  std::ranges::sort(order, {}, &SizeAnswers::radius_m);
  if (std::ranges::adjacent_find(order, {}, &SizeAnswers::radius_m) != order.end())
    throw std::invalid_argument("a scale study needs different sizes");
  Scatter s;
  double squares = 0.0;
  for (const SizeAnswers* size : order) {
    const auto n = static_cast<double>(size->displacement_m.size());
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(size->displacement_m.front().size());
    for (const Eigen::VectorXd& u : size->displacement_m) mean += u / n;
    auto& own = s.deviations.emplace_back();
    for (const Eigen::VectorXd& u : size->displacement_m) {
      own.emplace_back(u - mean);
      squares += own.back().squaredNorm();
    }
    s.radius_m.push_back(size->radius_m);
    s.num_packings.push_back(n);
    s.mean.push_back(std::move(mean));
    s.freedom += n - 1;
  }
  s.trace = squares / s.freedom;
  s.trace_of_square = trace_of_square(s);
  return s;
}

/// b_r' S b_s of the true differences: that of the measured ones less what scatter adds.
double along_differences(const Scatter& s, std::size_t r, std::size_t t, double share_of_scatter) {
  const Eigen::VectorXd one = s.mean[r] - s.mean[0];
  const Eigen::VectorXd other = s.mean[t] - s.mean[0];
  double sum = 0.0;
  for (const auto& own : s.deviations)
    for (const Eigen::VectorXd& e : own) sum += one.dot(e) * other.dot(e);
  return std::max(0.0, sum / s.freedom - s.trace_of_square * share_of_scatter);
}

/// Squares of the shares of the coarser sizes and their covariance.
struct Squares {
  double norm = 0.0;  // |u_f|^2 without scatter
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

Squares squares_of(const Scatter& s) {
  const auto m = static_cast<Eigen::Index>(s.mean.size()) - 1;
  const double finest = 1 / s.num_packings[0];
  Squares d{s.mean[0].squaredNorm() - s.trace * finest, Eigen::VectorXd(m), Eigen::MatrixXd(m, m)};
  for (Eigen::Index k = 0; k < m; ++k) {
    const auto r = static_cast<std::size_t>(k + 1);
    const double own = finest + 1 / s.num_packings[r];
    d.value[k] = ((s.mean[r] - s.mean[0]).squaredNorm() - s.trace * own) / d.norm;
    for (Eigen::Index l = 0; l < m; ++l) {
      const double shared = l == k ? own : finest;
      d.covariance(k, l) = (2 * s.trace_of_square * shared * shared +
                            4 * shared * along_differences(s, r, static_cast<std::size_t>(l + 1), shared)) /
                           (d.norm * d.norm);
    }
    d.covariance(k, k) += rounding;
  }
  return d;
}

ScaleLimit limit_of(const Scatter& s, const Squares& d, double tolerance) {
  ScaleLimit limit;
  limit.tolerance = tolerance;
  const double finest_m = s.radius_m.front(), coarsest_m = s.radius_m.back();
  Eigen::VectorXd square_m2(d.value.size());
  for (Eigen::Index k = 0; k < square_m2.size(); ++k)
    square_m2[k] = std::pow(s.radius_m[static_cast<std::size_t>(k + 1)] - finest_m, 2);
  const Eigen::VectorXd weight = square_m2.cwiseQuotient(d.covariance.diagonal());
  const double sum = weight.dot(square_m2);
  limit.slope_squared_per_m2 = weight.dot(d.value) / sum;
  limit.slope_squared_error = std::sqrt(weight.dot(d.covariance * weight)) / sum;
  const Eigen::VectorXd left = d.value - limit.slope_squared_per_m2 * square_m2;
  limit.misfit = left.size() > 1 ? left.dot(d.covariance.ldlt().solve(left))
                                 : std::numeric_limits<double>::quiet_NaN();
  const double high = limit.slope_squared_per_m2 + s.half_width_95() * limit.slope_squared_error;
  const double low = limit.slope_squared_per_m2 - s.half_width_95() * limit.slope_squared_error;
  const auto reach_m = [&](double slope_squared) { return finest_m + tolerance / std::sqrt(slope_squared); };
  limit.lo95_m = high > 0 ? reach_m(high) : std::numeric_limits<double>::infinity();
  limit.radius_m = std::numeric_limits<double>::quiet_NaN();
  if (low > 0) {
    limit.verdict = ScaleVerdict::found;
    limit.radius_m = reach_m(limit.slope_squared_per_m2);
    limit.hi95_m = reach_m(low);
  } else if (limit.lo95_m >= coarsest_m) {
    limit.verdict = ScaleVerdict::all_within;
  }
  return limit;
}

}  // namespace

const char* name_of(ScaleVerdict verdict) {
  switch (verdict) {
    case ScaleVerdict::found: return "found";
    case ScaleVerdict::all_within: return "all_within";
    case ScaleVerdict::undecided: return "undecided";
  }
  return "";
}

ScaleStudy study_scale(std::span<const SizeAnswers> sizes, double tolerance) {
  check(sizes, tolerance);
  const Scatter s = scatter_of(sizes);
  const Squares d = squares_of(s);
  if (!(d.norm > 0.0))
    throw std::invalid_argument("the finest size moves its tracers by less than their scatter");
  ScaleStudy study;
  study.sizes.emplace_back().radius_m = s.radius_m.front();
  for (Eigen::Index k = 0; k < d.value.size(); ++k) {
    const auto r = static_cast<std::size_t>(k + 1);
    const auto root = [](double square) { return std::sqrt(std::max(0.0, square)); };
    const double reach = s.half_width_95() * std::sqrt(d.covariance(k, k));
    const double own = s.trace * (1 / s.num_packings[0] + 1 / s.num_packings[r]) / d.norm;
    study.sizes.push_back({s.radius_m[r], root(d.value[k] + own), root(own), root(d.value[k]),
                           root(d.value[k] - reach), root(d.value[k] + reach)});
  }
  study.limit = limit_of(s, d, tolerance);
  return study;
}

std::vector<Drift> drift_of(std::span<const double> radii_m, std::span<const std::vector<double>> values) {
  if (radii_m.size() != values.size() || radii_m.empty())
    throw std::invalid_argument("one list of values per radius");
  std::vector<Drift> drift;
  for (std::size_t k = 0; k < radii_m.size(); ++k) {
    const auto n = static_cast<double>(values[k].size());
    Drift d;
    d.radius_m = radii_m[k];
    for (const double v : values[k]) d.mean += v / n;
    for (const double v : values[k]) d.sd += (v - d.mean) * (v - d.mean) / (n - 1);
    d.sd = std::sqrt(d.sd);
    drift.push_back(d);
  }
  std::vector<std::size_t> order(drift.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::sort(order, {}, [&](std::size_t k) { return radii_m[k]; });
  std::vector<Drift> sorted;
  const Drift& finest = drift[order[0]];
  const double finest_share =
      finest.sd / std::abs(finest.mean) / std::sqrt(static_cast<double>(values[order[0]].size()));
  for (const std::size_t k : order) {
    Drift d = drift[k];
    d.over_finest = d.mean / finest.mean;
    const double share = d.sd / std::abs(d.mean) / std::sqrt(static_cast<double>(values[k].size()));
    d.over_finest_error = &drift[k] == &finest ? 0.0 : std::abs(d.over_finest) * std::hypot(share, finest_share);
    sorted.push_back(d);
  }
  return sorted;
}

}  // namespace tilth
