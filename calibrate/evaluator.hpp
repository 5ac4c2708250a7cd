// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Runs a Simulator for a fit: counts, remembers, records failures, obeys budget and stop.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "calibrate/simulator.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// Where a fit stands, told after every batch.
struct Progress {
  std::string stage;
  std::size_t num_done = 0;      ///< simulations, completed and failed
  std::size_t num_expected = 0;  ///< an estimate for the whole fit
};

/// Simulations of one stage.
struct StageCount {
  std::string stage;
  std::size_t num_completed = 0;
  std::size_t num_failed = 0;
};

/// One failed simulation, with everything needed to run it again.
struct FailedRun {
  std::string stage;
  std::string simulator;       ///< "search" or "confirm"
  Eigen::VectorXd parameters;  ///< physical, all of them
  std::uint64_t seed = 0;
  std::string message;
};

/// The account of a whole fit, shared by its evaluators: limits going in, counts coming out.
struct SimulationLedger {
  std::size_t max_simulations = 0;  ///< budget, completed and failed together
  std::size_t num_reserved = 0;     ///< held back for the last stages; they set it to 0
  std::size_t num_expected = 0;     ///< passed on to progress
  /// A batch of at least min_batch_for_failure_rule runs with more than this share failed ends
  /// the fit.
  double max_failed_share = 0.3;
  std::size_t min_batch_for_failure_rule = 8;
  std::function<bool()> should_stop;              ///< asked before every batch; may be empty
  std::function<void(const Progress&)> progress;  ///< may be empty

  std::string stage;               ///< name of the running stage, see begin_stage()
  std::vector<StageCount> stages;  ///< in order of first use
  std::vector<FailedRun> failures;
  std::size_t num_done = 0;
  bool stop_seen = false;          ///< should_stop() said yes
  bool budget_spent = false;       ///< a run was, or would have been, refused for it
  bool too_many_failures = false;  ///< the failure rule fired
};

/// Following runs are booked under this name.
void begin_stage(SimulationLedger& ledger, const std::string& stage);
/// Should the fit wind down: no batch with a new run will be started. Asks should_stop() and
/// raises the flags above.
bool is_blocked(SimulationLedger& ledger);

/// Which targets a simulator answers; the features of the others are NaN and mean "not asked".
enum class TargetScope { all, fitted, holdouts };

/// What a NaN among the features asked for means.
enum class MissingFeatures {
  fail_run,  ///< the run has failed
  keep       ///< this feature is missing, the others stand (partial simulators)
};

/// A Simulator with a memory. Results are remembered by (parameters, seed), bit for bit, so
/// nothing is simulated twice. When the ledger is blocked, remembered results are still given
/// and everything else is `skipped`.
class Evaluator {
 public:
  /// @param label  "search", "confirm" or "hold-outs", for the record of failures
  /// @param ledger must outlive the evaluator
  Evaluator(Simulator simulator, std::vector<Target> targets, std::string label,
            SimulationLedger& ledger, TargetScope scope = TargetScope::all,
            MissingFeatures missing = MissingFeatures::fail_run);

  /// One Evaluation per column, in order. A completed run has finite features of the targets in
  /// scope, and positive ones for fitted targets with log_transform; otherwise it is failed. With
  /// MissingFeatures::keep one finite feature is enough; what is not finite becomes NaN.
  /// All of one call may run side by side.
  /// @shape parameters (num_parameters, num_members), physical; seeds (num_members)
  /// @throws std::runtime_error if the simulator does not return one Evaluation per column
  std::vector<Evaluation> evaluate(const Eigen::MatrixXd& parameters,
                                   std::span<const std::uint64_t> seeds);
  /// All members on one seed.
  std::vector<Evaluation> evaluate(const Eigen::MatrixXd& parameters, std::uint64_t seed);

 private:
  using Key = std::pair<std::uint64_t, std::vector<double>>;

  std::vector<Key> new_keys(const Eigen::MatrixXd& parameters,
                            std::span<const std::uint64_t> seeds);
  void run(const std::vector<Key>& keys);
  void check(Evaluation& evaluation) const;
  void book(const Key& key, const Evaluation& evaluation);

  Simulator simulator_;
  std::vector<Target> targets_;
  std::string label_;
  SimulationLedger& ledger_;
  TargetScope scope_;
  MissingFeatures missing_;
  std::map<Key, Evaluation> memory_;
};

}  // namespace tilth
