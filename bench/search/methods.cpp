// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "bench/search/methods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "calibrate/fit.hpp"
#include "calibrate/optimise_ceres.hpp"

namespace tilth::bench {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Packings of a twin begin here for all methods, so that nobody has the luckier ones.
std::uint64_t first_packing(const Twin& twin) { return 1 + 10'000 * twin.stream; }

// Random points of the unit cube, the same for all methods of a twin.
class Starts {
 public:
  explicit Starts(const Twin& twin) : rng_(twin.stream) {}
  Eigen::VectorXd next() {
    Eigen::VectorXd unit(3);
    for (double& u : unit) u = static_cast<double>(rng_() >> 11) * 0x1p-53;
    return unit;
  }

 private:
  std::mt19937_64 rng_;
};

// Holds the best point so far against the noise-free chi-square.
class Judge {
 public:
  Judge(const StandIn& stand_in, const Twin& twin) : stand_in_(stand_in), twin_(twin) {}

  double excess(const Eigen::VectorXd& unit) const {
    return noise_free_chi_square(stand_in_, twin_, unit) - twin_.least;
  }
  void see(const Eigen::VectorXd& best) {
    const double above = excess(best);
    if (!outcome.to_floor && above <= noise_floor) {
      outcome.to_floor = outcome.num_simulations;
      outcome.calls_to_floor = outcome.num_calls;
    }
    if (!outcome.to_strict_floor && above <= strict_floor) {
      outcome.to_strict_floor = outcome.num_simulations;
    }
  }

  Outcome outcome;

 private:
  const StandIn& stand_in_;
  const Twin& twin_;
};

struct Ended {};  // thrown through a plain search when there is nothing left to learn from it

// The objective of a plain search. A point is simulated once, however often it is asked for.
class PlainObjective {
 public:
  PlainObjective(const StandIn& stand_in, const Twin& twin, int num_packings)
      : stand_in_(stand_in), twin_(twin), num_packings_(num_packings), judge_(stand_in, twin) {}

  /// Empty if the point's run fails. @throws Ended at the strict floor and at the cap
  std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& unit) {
    const auto [entry, is_new] = memory_.try_emplace(std::vector<double>(unit.begin(), unit.end()));
    if (!is_new) return entry->second;
    if (judge_.outcome.num_simulations + static_cast<std::size_t>(num_packings_) >
        stand_in_.most_simulations)
      throw Ended{};
    ++judge_.outcome.num_calls;
    const std::optional<Eigen::VectorXd> mean = mean_over_packings(unit);
    if (!mean) return std::nullopt;
    entry->second = residuals_of(stand_in_, twin_, *mean, num_packings_);
    const double value = entry->second->squaredNorm();
    if (value < best_) {
      best_ = value;
      judge_.see(unit);
      if (judge_.outcome.to_strict_floor) throw Ended{};
    }
    return entry->second;
  }

  const Outcome& outcome() const { return judge_.outcome; }

 private:
  // Failure is a matter of the parameters: the first failed packing saves the others.
  std::optional<Eigen::VectorXd> mean_over_packings(const Eigen::VectorXd& unit) {
    const Eigen::VectorXd physical = physical_point(stand_in_.parameters, unit);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(twin_.targets.size()));
    for (int i = 0; i < num_packings_; ++i) {
      ++judge_.outcome.num_simulations;
      const Evaluation run = stand_in_.run(
          physical, first_packing(twin_) + static_cast<std::uint64_t>(i), twin_.stream);
      if (run.status != EvaluationStatus::completed) return std::nullopt;
      for (Eigen::Index k = 0; k < mean.size(); ++k) {
        mean[k] += transformed(twin_.targets[static_cast<std::size_t>(k)], run.features[k]);
      }
    }
    return mean / num_packings_;
  }

  const StandIn& stand_in_;
  const Twin& twin_;
  int num_packings_;
  Judge judge_;
  double best_ = infinite;
  std::map<std::vector<double>, std::optional<Eigen::VectorXd>> memory_;
};

// Calls search(start, number) at random starts until the objective ends it.
template <class Search>
Outcome with_restarts(const Twin& twin, const PlainObjective& objective, const Search& search) {
  Starts starts(twin);
  try {
    for (std::uint64_t number = 0;; ++number) search(starts.next(), number);
  } catch (const Ended&) {
    return objective.outcome();
  }
}

// One simulation as the fit asked for it.
struct Asked {
  std::string stage;
  std::size_t call = 0;  // of the simulator, from 1
  std::uint64_t seed = 0;
  Eigen::VectorXd unit;
  std::optional<Eigen::VectorXd> transformed;  // empty if it failed
};

// Replays the simulations of a fit in order and follows its best point.
class Replay {
 public:
  Replay(const StandIn& stand_in, const Twin& twin, const FitOptions& options)
      : stand_in_(stand_in), twin_(twin), options_(options), judge_(stand_in, twin) {}

  Outcome judged(const std::vector<Asked>& runs) {
    for (const Asked& run : runs) add(run);
    return judge_.outcome;
  }

 private:
  using Key = std::vector<double>;

  void add(const Asked& run) {
    ++judge_.outcome.num_simulations;
    judge_.outcome.num_calls = run.call;
    if (!run.transformed || run.seed >= last_search_seed()) return;
    const Key key(run.unit.begin(), run.unit.end());
    auto& seen = runs_[key];
    seen.emplace(run.seed, *run.transformed);
    const bool is_complete = seen.size() == static_cast<std::size_t>(options_.num_search_seeds);
    if (run.stage == "design" || run.stage == "noise floor" || run.stage == "search") {
      if (is_complete) complete_.insert(key);
      see_one_packing(run);
      return;
    }
    if (!is_complete) return;
    if (!is_local_) start_local();
    see_complete(key);
  }

  std::uint64_t last_search_seed() const {
    return options_.seed + static_cast<std::uint64_t>(options_.num_search_seeds);
  }
  void see_one_packing(const Asked& run) {
    if (run.seed != options_.seed) return;
    see(run.unit, residuals_of(stand_in_, twin_, *run.transformed, 1).squaredNorm());
  }
  void start_local() {
    is_local_ = true;
    best_ = infinite;
    for (const Key& key : complete_) see_complete(key);
  }
  void see_complete(const Key& key) {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(twin_.targets.size()));
    for (const auto& [seed, transformed] : runs_[key]) {
      mean += transformed / static_cast<double>(options_.num_search_seeds);
    }
    const Eigen::VectorXd unit =
        Eigen::Map<const Eigen::VectorXd>(key.data(), static_cast<Eigen::Index>(key.size()));
    see(unit, residuals_of(stand_in_, twin_, mean, options_.num_search_seeds).squaredNorm());
  }
  void see(const Eigen::VectorXd& unit, double value) {
    if (value >= best_) return;
    best_ = value;
    judge_.see(unit);
  }

  const StandIn& stand_in_;
  const Twin& twin_;
  const FitOptions& options_;
  Judge judge_;
  bool is_local_ = false;
  double best_ = infinite;
  std::map<Key, std::map<std::uint64_t, Eigen::VectorXd>> runs_;
  std::set<Key> complete_;
};

Eigen::VectorXd unit_of(const StandIn& stand_in, const Eigen::VectorXd& physical) {
  Eigen::VectorXd unit(physical.size());
  for (Eigen::Index j = 0; j < unit.size(); ++j) {
    unit[j] = unit_from_physical(stand_in.parameters[static_cast<std::size_t>(j)], physical[j]);
  }
  return unit;
}

Asked asked(const StandIn& stand_in, const Twin& twin, const Eigen::VectorXd& physical,
            std::uint64_t seed, const Evaluation& run) {
  Asked result{"", 0, seed, unit_of(stand_in, physical), std::nullopt};
  if (run.status != EvaluationStatus::completed) return result;
  result.transformed.emplace(run.features.size());
  for (Eigen::Index k = 0; k < run.features.size(); ++k) {
    (*result.transformed)[k] =
        transformed(twin.targets[static_cast<std::size_t>(k)], run.features[k]);
  }
  return result;
}

// Forward difference; backward where the bound or a failed run is in the way.
std::optional<Eigen::VectorXd> one_sided_slope(PlainObjective& objective,
                                               const Eigen::VectorXd& unit,
                                               const Eigen::VectorXd& base, Eigen::Index j,
                                               double step) {
  for (const double way : {step, -step}) {
    Eigen::VectorXd moved = unit;
    moved[j] += way;
    if (moved[j] < 0.0 || moved[j] > 1.0) continue;
    if (const auto there = objective.residuals(moved)) return (*there - base) / way;
  }
  return std::nullopt;
}

}  // namespace

Outcome run_nlopt(const StandIn& stand_in, const Twin& twin, NloptAlgorithm algorithm,
                  int num_packings) {
  PlainObjective objective(stand_in, twin, num_packings);
  const auto value = [&](const Eigen::VectorXd& unit) {
    const auto residuals = objective.residuals(unit);
    return residuals ? residuals->squaredNorm() : infinite;
  };
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(3);
  const Eigen::VectorXd upper = Eigen::VectorXd::Ones(3);
  const auto cap = static_cast<int>(stand_in.most_simulations);
  return with_restarts(twin, objective, [&](const Eigen::VectorXd& start, std::uint64_t number) {
    minimise_with_nlopt(value, lower, upper, start, {algorithm, cap, 1e-3, number + 1});
  });
}

Outcome run_ceres(const StandIn& stand_in, const Twin& twin, double step, int num_packings) {
  PlainObjective objective(stand_in, twin, num_packings);
  LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Zero(3);
  problem.upper = Eigen::VectorXd::Ones(3);
  problem.num_residuals = static_cast<int>(twin.targets.size());
  problem.evaluate = [&](const Eigen::VectorXd& unit, Eigen::VectorXd& residuals,
                         Eigen::MatrixXd* jacobian) {
    const auto base = objective.residuals(unit);
    if (!base) return false;
    residuals = *base;
    for (Eigen::Index j = 0; jacobian != nullptr && j < unit.size(); ++j) {
      const auto slope = one_sided_slope(objective, unit, *base, j, step);
      if (!slope) return false;
      jacobian->col(j) = *slope;
    }
    return true;
  };
  return with_restarts(twin, objective, [&](const Eigen::VectorXd& start, std::uint64_t) {
    minimise_with_ceres(problem, start, {});
  });
}

Outcome run_fit(const StandIn& stand_in, const Twin& twin, FitOptions options) {
  std::vector<Parameter> parameters = stand_in.parameters;
  const Eigen::VectorXd start = physical_point(parameters, Starts(twin).next());
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    parameters[j].start = start[static_cast<Eigen::Index>(j)];
  }
  std::vector<Asked> runs;
  std::size_t num_labelled = 0;
  std::size_t num_calls = 0;
  options.seed = first_packing(twin);
  options.progress = [&](const Progress& progress) {
    for (; num_labelled < runs.size(); ++num_labelled) runs[num_labelled].stage = progress.stage;
  };
  const Simulator inner = simulator_of(stand_in, twin);
  const Simulator recorded = [&](const Eigen::MatrixXd& points,
                                 std::span<const std::uint64_t> seeds) {
    const std::vector<Evaluation> results = inner(points, seeds);
    ++num_calls;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const Eigen::VectorXd point = points.col(static_cast<Eigen::Index>(i));
      runs.push_back(asked(stand_in, twin, point, seeds[i], results[i]));
      runs.back().call = num_calls;
    }
    return results;
  };
  const FitSummary summary = fit(parameters, twin.targets, recorded, nullptr, options);
  Outcome outcome = Replay(stand_in, twin, options).judged(runs);
  if (!summary.is_usable()) return outcome;
  outcome.excess_returned = Judge(stand_in, twin).excess(unit_of(stand_in, summary.values()));
  return outcome;
}

}  // namespace tilth::bench
