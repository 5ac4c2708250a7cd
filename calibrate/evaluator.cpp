// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/evaluator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace tilth {
namespace {

std::size_t num_affordable(const SimulationLedger& ledger) {
  const std::size_t used = ledger.num_done + ledger.num_reserved;
  return used < ledger.max_simulations ? ledger.max_simulations - used : 0;
}

bool is_asked(const Target& target, TargetScope scope) {
  return scope == TargetScope::all || target.holdout == (scope == TargetScope::holdouts);
}

std::vector<double> to_vector(const Eigen::VectorXd& point) { return {point.begin(), point.end()}; }

}  // namespace

void begin_stage(SimulationLedger& ledger, const std::string& stage) {
  ledger.stage = stage;
  for (const StageCount& count : ledger.stages) {
    if (count.stage == stage) return;
  }
  ledger.stages.push_back({stage, 0, 0});
}

bool is_blocked(SimulationLedger& ledger) {
  if (!ledger.stop_seen && ledger.should_stop && ledger.should_stop()) ledger.stop_seen = true;
  if (num_affordable(ledger) == 0) ledger.budget_spent = true;
  return ledger.stop_seen || ledger.too_many_failures || num_affordable(ledger) == 0;
}

Evaluator::Evaluator(Simulator simulator, std::vector<Target> targets, std::string label,
                     SimulationLedger& ledger, TargetScope scope, MissingFeatures missing)
    : simulator_(std::move(simulator)),
      targets_(std::move(targets)),
      label_(std::move(label)),
      ledger_(ledger),
      scope_(scope),
      missing_(missing) {}

std::vector<Evaluation> Evaluator::evaluate(const Eigen::MatrixXd& parameters, std::uint64_t seed) {
  return evaluate(parameters,
                  std::vector<std::uint64_t>(static_cast<std::size_t>(parameters.cols()), seed));
}

std::vector<Evaluation> Evaluator::evaluate(const Eigen::MatrixXd& parameters,
                                            std::span<const std::uint64_t> seeds) {
  const std::vector<Key> keys = new_keys(parameters, seeds);
  if (!keys.empty()) run(keys);

  std::vector<Evaluation> evaluations;
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    const auto known =
        memory_.find({seeds[static_cast<std::size_t>(i)], to_vector(parameters.col(i))});
    evaluations.push_back(known != memory_.end() ? known->second : Evaluation{});
  }
  return evaluations;
}

// What must be simulated and may be: unknown, once each, within stop and budget.
std::vector<Evaluator::Key> Evaluator::new_keys(const Eigen::MatrixXd& parameters,
                                                std::span<const std::uint64_t> seeds) {
  std::vector<Key> keys;
  std::set<Key> queued;
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    Key key{seeds[static_cast<std::size_t>(i)], to_vector(parameters.col(i))};
    if (!memory_.contains(key) && queued.insert(key).second) keys.push_back(std::move(key));
  }
  if (keys.empty()) return keys;
  if (num_affordable(ledger_) < keys.size()) ledger_.budget_spent = true;
  if (is_blocked(ledger_)) return {};
  if (num_affordable(ledger_) < keys.size()) keys.resize(num_affordable(ledger_));
  return keys;
}

void Evaluator::run(const std::vector<Key>& keys) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(keys.front().second.size()),
                          static_cast<Eigen::Index>(keys.size()));
  std::vector<std::uint64_t> seeds;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto& [seed, point] = keys[i];
    seeds.push_back(seed);
    columns.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::VectorXd>(point.data(), columns.rows());
  }
  std::vector<Evaluation> evaluations = simulator_(columns, seeds);
  if (evaluations.size() != keys.size()) {
    throw std::runtime_error(fmt::format("the {} simulator returned {} results for {} members",
                                         label_, evaluations.size(), keys.size()));
  }

  std::size_t num_failed = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    check(evaluations[i]);
    if (evaluations[i].status == EvaluationStatus::skipped) {
      is_blocked(ledger_);  // notes the stop: there may be no later batch to ask
      continue;
    }
    if (evaluations[i].status == EvaluationStatus::failed) ++num_failed;
    book(keys[i], evaluations[i]);
  }
  if (keys.size() >= ledger_.min_batch_for_failure_rule &&
      static_cast<double>(num_failed) >
          ledger_.max_failed_share * static_cast<double>(keys.size())) {
    ledger_.too_many_failures = true;
  }
  if (ledger_.progress) ledger_.progress({ledger_.stage, ledger_.num_done, ledger_.num_expected});
}

// Turns a result that cannot be used into a failed one that says why.
void Evaluator::check(Evaluation& evaluation) const {
  const auto fail = [&](std::string message) {
    evaluation = {EvaluationStatus::failed, {}, std::move(message)};
  };
  if (evaluation.status == EvaluationStatus::failed) {
    evaluation.features.resize(0);
    if (evaluation.message.empty()) evaluation.message = "the simulator gave no reason";
  }
  if (evaluation.status != EvaluationStatus::completed) return;
  if (evaluation.features.size() != static_cast<Eigen::Index>(targets_.size())) {
    return fail(fmt::format("returned {} features, expected {}", evaluation.features.size(),
                            targets_.size()));
  }
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    double& value = evaluation.features[static_cast<Eigen::Index>(k)];
    if (!is_asked(targets_[k], scope_)) {
      value = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    if (!std::isfinite(value) && missing_ == MissingFeatures::keep) {
      value = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    if (!std::isfinite(value)) {
      return fail(fmt::format("{} = {}: not finite", targets_[k].name, value));
    }
    if (!targets_[k].holdout && std::isnan(transformed(targets_[k], value))) {
      return fail(fmt::format("{} = {}: must be positive to be compared by its logarithm",
                              targets_[k].name, value));
    }
  }
  if (missing_ == MissingFeatures::keep && evaluation.features.array().isNaN().all())
    fail(evaluation.message.empty() ? "no feature is finite" : evaluation.message);
}

void Evaluator::book(const Key& key, const Evaluation& evaluation) {
  memory_.emplace(key, evaluation);
  ++ledger_.num_done;
  if (ledger_.stages.empty()) begin_stage(ledger_, ledger_.stage);
  StageCount* count = &ledger_.stages.front();
  for (StageCount& candidate : ledger_.stages) {
    if (candidate.stage == ledger_.stage) count = &candidate;
  }
  if (evaluation.status == EvaluationStatus::completed) {
    ++count->num_completed;
    return;
  }
  ++count->num_failed;
  const Eigen::Map<const Eigen::VectorXd> point(key.second.data(),
                                                static_cast<Eigen::Index>(key.second.size()));
  ledger_.failures.push_back({ledger_.stage, label_, point, key.first, evaluation.message});
}

}  // namespace tilth
