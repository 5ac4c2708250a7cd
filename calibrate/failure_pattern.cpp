// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/failure_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace tilth {
namespace {

// Runs of one row at one value of a parameter.
struct Unit {
  double u = 0.0;
  double num_runs = 0.0;
  double num_failed = 0.0;
};

std::vector<Unit> units_of(const std::vector<SampleRow>& rows, const Eigen::MatrixXd& is_failed,
                           Eigen::Index parameter) {
  std::vector<Unit> units;
  for (Eigen::Index r = 0; r < is_failed.cols(); ++r) {
    std::map<double, Unit> of_value;
    for (Eigen::Index i = 0; i < is_failed.rows(); ++i) {
      const double u = rows[static_cast<std::size_t>(r)].unit(parameter, i);
      Unit& unit = of_value[u];
      unit.u = u;
      unit.num_runs += 1.0;
      unit.num_failed += is_failed(i, r);
    }
    for (const auto& [u, unit] : of_value) units.push_back(unit);
  }
  return units;
}

double permutation_p_value(const Eigen::ArrayXd& scores, const Eigen::ArrayXd& shares) {
  const Eigen::ArrayXd s = scores - scores.mean();
  const Eigen::ArrayXd c = shares - shares.mean();
  const double variance = s.square().sum() * c.square().sum() / static_cast<double>(s.size() - 1);
  if (!(variance > 0.0)) return 1.0;
  return std::erfc(std::abs((s * c).sum()) / std::sqrt(2.0 * variance));
}

ParameterFailures failures_along(const std::vector<Unit>& units) {
  Eigen::ArrayXd u(static_cast<Eigen::Index>(units.size()));
  Eigen::ArrayXd share(u.size());
  std::array<double, 3> runs{}, failed{};
  for (std::size_t i = 0; i < units.size(); ++i) {
    u[static_cast<Eigen::Index>(i)] = units[i].u;
    share[static_cast<Eigen::Index>(i)] = units[i].num_failed / units[i].num_runs;
    const auto third = std::min<std::size_t>(2, static_cast<std::size_t>(3.0 * units[i].u));
    runs[third] += units[i].num_runs;
    failed[third] += units[i].num_failed;
  }
  ParameterFailures result;
  for (std::size_t k = 0; k < 3; ++k) result.shares[k] = failed[k] / runs[k];
  const double p =
      std::min(permutation_p_value(u, share), permutation_p_value((u - 0.5).abs(), share));
  result.p_value = std::min(1.0, 2.0 * p);
  return result;
}

FailureVerdict verdict_of(const FailurePattern& pattern) {
  if (pattern.num_failed == 0) return FailureVerdict::none;
  double smallest = 1.0;
  for (const ParameterFailures& p : pattern.parameters) smallest = std::min(smallest, p.p_value);
  if (smallest * static_cast<double>(pattern.parameters.size()) < failure_significance)
    return FailureVerdict::concentrated;
  return pattern.num_failed < min_failures_for_a_pattern ? FailureVerdict::too_few
                                                         : FailureVerdict::no_pattern;
}

}  // namespace

std::string_view to_string(FailureVerdict verdict) {
  switch (verdict) {
    case FailureVerdict::none:
      return "none";
    case FailureVerdict::no_pattern:
      return "no_pattern";
    case FailureVerdict::too_few:
      return "too_few";
    case FailureVerdict::concentrated:
      return "concentrated";
  }
  return "";
}

double FailurePattern::share() const {
  return num_runs == 0 ? 0.0 : static_cast<double>(num_failed) / static_cast<double>(num_runs);
}

FailurePattern failure_pattern(const std::vector<SampleRow>& rows,
                               const Eigen::MatrixXd& is_failed) {
  FailurePattern pattern;
  pattern.num_runs = static_cast<std::size_t>(is_failed.size());
  pattern.num_failed = static_cast<std::size_t>(is_failed.sum());
  const Eigen::Index num_free = rows.empty() ? 0 : rows.front().unit.rows();
  for (Eigen::Index j = 0; j < num_free && pattern.num_failed > 0; ++j)
    pattern.parameters.push_back(failures_along(units_of(rows, is_failed, j)));
  pattern.verdict = verdict_of(pattern);
  return pattern;
}

}  // namespace tilth
