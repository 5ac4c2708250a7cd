// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/measured_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calibrate/diagnosis/thresholds.hpp"
#include "calibrate/moderated_variances.hpp"

namespace tilth {
namespace {

using Problems = std::vector<std::string>;

/// Freedom from which a pooled variance is believed.
constexpr double least_pooled_freedom = 4.0;
/// A coefficient of variation below this is none: readings are rounded.
constexpr double no_scatter = 1e-9;

/// The rows of one number: one per specimen.
struct Gathered {
  std::vector<const SoilTarget*> rows;
};

bool same_number(const SoilTarget& a, const SoilTarget& b) {
  return a.test_id == b.test_id && a.observable_id == b.observable_id && a.condition_id == b.condition_id;
}

std::vector<Gathered> gathered(const SoilData& soil, Problems& problems) {
  std::vector<Gathered> numbers;
  for (const SoilTarget& row : soil.targets) {
    if (row.x) {
      problems.push_back(label(row) + ": points of a curve cannot be diagnosed; give named features (calibrate features)");
      continue;
    }
    const auto found = std::ranges::find_if(
        numbers, [&](const Gathered& g) { return same_number(*g.rows.front(), row); });
    if (found == numbers.end()) numbers.push_back({{&row}});
    else found->rows.push_back(&row);
  }
  return numbers;
}

bool is_positive_by_nature(const SoilTarget& t) {
  const KnownObservable* known = soil_vocabulary().observable(t.test_id, t.observable_id);
  return known && known->plausible_lower > 0.0;
}

/// T of one row.
double statistic(const SoilTarget& row, bool logs) { return logs ? std::log(row.value) : row.value; }

/// The stated standard deviation of one row in T.
double stated_sigma(const SoilTarget& row, bool logs) {
  if (!logs) return sigma_of(row);
  return row.sigma_kind == SigmaKind::log ? row.sigma : sigma_of(row) / std::abs(row.value);
}

/// Size of a number that may have either sign: its mean, or its sigma where it is near zero.
double size_of(const Gathered& g) {
  double size = 0.0;
  for (const SoilTarget* row : g.rows)
    size = std::max({size, std::abs(row->value), 3.0 * sigma_of(*row)});
  return size;
}

/// Rows of specimens that have all numbers of the test.
Eigen::MatrixXd whole_specimens(const std::vector<const Gathered*>& numbers, const std::vector<bool>& logs,
                                std::size_t& num_left_out) {
  std::map<std::string, std::vector<double>> specimens;  // by replicateId
  std::vector<std::string> order;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    for (const SoilTarget* row : numbers[k]->rows) {
      const auto [at, is_new] = specimens.try_emplace(row->replicate_id, numbers.size(), std::nan(""));
      if (is_new) order.push_back(row->replicate_id);
      at->second[k] = statistic(*row, logs[k]);
    }
  // The same specimens in another order must give the same bits.
  std::ranges::sort(order);
  std::vector<std::vector<double>> whole;
  for (const std::string& id : order) {
    const std::vector<double>& s = specimens[id];
    if (std::ranges::all_of(s, [](double v) { return std::isfinite(v); })) whole.push_back(s);
  }
  num_left_out = order.size() - whole.size();
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(whole.size()), static_cast<Eigen::Index>(numbers.size()));
  for (Eigen::Index n = 0; n < rows.rows(); ++n)
    for (Eigen::Index k = 0; k < rows.cols(); ++k)
      rows(n, k) = whole[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
  return rows;
}

/// Pooled sample variances by test and observable.
struct Pool {
  double squares = 0.0, freedom = 0.0;
};

void set_prior_variances(const std::vector<double>& stated, MeasuredCampaign& c) {
  std::map<std::string, Pool> pools;
  const auto name = [&](Eigen::Index k) {
    const SoilTarget& t = c.means.targets[static_cast<std::size_t>(k)];
    return t.test_id + "/" + t.observable_id;
  };
  for (const MeasuredTest& test : c.tests) {
    const auto freedom = static_cast<double>(test.replicates.rows() - 1);
    if (freedom < 1.0) continue;
    const Eigen::VectorXd v = sample_variances(test.replicates.transpose());
    for (std::size_t k = 0; k < test.statistics.size(); ++k) {
      Pool& pool = pools[name(test.statistics[k])];
      pool.squares += freedom * v[static_cast<Eigen::Index>(k)];
      pool.freedom += freedom;
    }
  }
  c.prior_variances.resize(static_cast<Eigen::Index>(stated.size()));
  for (Eigen::Index k = 0; k < c.prior_variances.size(); ++k) {
    const double sigma = stated[static_cast<std::size_t>(k)];
    const Pool pool = pools[name(k)];
    const double pooled = pool.freedom > 0.0 ? pool.squares / pool.freedom : 0.0;
    const bool scatters = pooled > no_scatter * no_scatter;
    if (pool.freedom > 0.0 && !scatters)
      c.remarks.push_back(fmt::format("replicates of {} are all equal: no scatter was measured, the stated sigma ({:.3g}) stands in",
                                      name(k), sigma));
    c.has_replicates = c.has_replicates || scatters;
    c.prior_variances[k] = scatters && pool.freedom >= least_pooled_freedom ? pooled : sigma * sigma;
  }
  std::ranges::sort(c.remarks);
  c.remarks.erase(std::unique(c.remarks.begin(), c.remarks.end()), c.remarks.end());
}

/// Means of the specimens with the standard error of the moderated variance.
void set_means(MeasuredCampaign& c) {
  for (const MeasuredTest& test : c.tests) {
    Eigen::VectorXd prior(static_cast<Eigen::Index>(test.statistics.size()));
    for (std::size_t k = 0; k < test.statistics.size(); ++k)
      prior[static_cast<Eigen::Index>(k)] = c.prior_variances[test.statistics[k]];
    const Eigen::VectorXd v = moderated_variances(test.replicates.transpose(), prior,
                                                  diagnosis_thresholds::moderation_freedom);
    for (std::size_t k = 0; k < test.statistics.size(); ++k) {
      const auto j = static_cast<Eigen::Index>(k);
      SoilTarget& t = c.means.targets[static_cast<std::size_t>(test.statistics[k])];
      const double mean = test.replicates.col(j).mean();
      const double error = std::sqrt(v[j] / static_cast<double>(test.replicates.rows()));
      t.value = t.sigma_kind == SigmaKind::log ? std::exp(mean) : mean;
      t.sigma = error;
    }
  }
}

}  // namespace

MeasuredCampaign measured_campaign(const SoilData& soil) {
  Problems problems;
  const std::vector<Gathered> numbers = gathered(soil, problems);
  MeasuredCampaign c;
  c.means = soil;
  c.means.targets.clear();
  c.means.superseded.clear();
  std::vector<bool> logs;
  std::vector<double> scales, stated;
  for (const Gathered& g : numbers) {
    const SoilTarget& first = *g.rows.front();
    logs.push_back(is_positive_by_nature(first));
    scales.push_back(logs.back() ? 1.0 : size_of(g));
    double squares = 0.0;
    for (const SoilTarget* row : g.rows) {
      if (logs.back() && !(row->value > 0.0))
        problems.push_back(fmt::format("{} = {}: must be > 0", label(*row), row->value));
      const double sigma = stated_sigma(*row, logs.back());
      squares += sigma * sigma / static_cast<double>(g.rows.size());
      if (row->holdout != first.holdout)
        problems.push_back(label(*row) + ": some of its replicates are held out and some are not");
    }
    stated.push_back(std::sqrt(squares));
    SoilTarget mean = first;
    mean.replicate_id.clear();
    mean.sigma_kind = logs.back() ? SigmaKind::log : SigmaKind::absolute;
    // Specimens of one mean are one observation; two observables of a test are two.
    c.means.targets.push_back(mean);
  }
  if (!problems.empty()) throw ConfigError(problems);
  c.scale = Eigen::Map<const Eigen::VectorXd>(scales.data(), static_cast<Eigen::Index>(scales.size()));

  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const SoilTarget& t = *numbers[k].rows.front();
    auto test = std::ranges::find_if(c.tests, [&](const MeasuredTest& m) {
      return m.experiment == t.test_id && m.condition_id == t.condition_id;
    });
    if (test == c.tests.end()) test = c.tests.insert(c.tests.end(), {t.test_id, t.condition_id, {}, {}});
    test->statistics.push_back(static_cast<Eigen::Index>(k));
  }
  for (MeasuredTest& test : c.tests) {
    std::vector<const Gathered*> own;
    std::vector<bool> own_logs;
    for (const Eigen::Index k : test.statistics) {
      own.push_back(&numbers[static_cast<std::size_t>(k)]);
      own_logs.push_back(logs[static_cast<std::size_t>(k)]);
    }
    std::size_t num_left_out = 0;
    test.replicates = whole_specimens(own, own_logs, num_left_out);
    if (test.replicates.rows() == 0)
      throw ConfigError({fmt::format("{} under {}: no specimen has all its numbers; give replicateId the same word in all rows of a specimen",
                                     test.experiment, test.condition_id)});
    if (num_left_out > 0)
      c.remarks.push_back(fmt::format("{} under {}: {} specimens without all numbers were left out",
                                      test.experiment, test.condition_id, num_left_out));
  }
  set_prior_variances(stated, c);
  set_means(c);
  return c;
}

}  // namespace tilth
