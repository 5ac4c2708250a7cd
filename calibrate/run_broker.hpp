// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Simulations from the store where it has them, else from worker processes into the store.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calibrate/run_record.hpp"
#include "calibrate/run_store.hpp"
#include "calibrate/worker_pool.hpp"

namespace tilth {

struct BrokerOptions {
  double run_timeout_s = 1800;  ///< per job; longer is overdue
  int max_tries = 3;            ///< of one run that crashes, hangs or gives NaN; then abandoned
  int max_members = 8;          ///< of one job: parameter sets that ride in one pack
  std::function<StopWish()> stop;  ///< may be empty
  /// How long a run takes beside others of its setup, in any unit: a pack lasts as long as its longest member, so those of like
  /// effort ride together. May be empty.
  std::function<double(const RunIdentity&)> effort;
  /// Told after every job: runs that have ended and runs of this call. May be empty.
  std::function<void(std::size_t num_done, std::size_t num_all)> progress;
};

/// What a broker has done so far.
struct BrokerCounts {
  std::size_t num_from_store = 0;
  std::size_t num_simulated = 0;  ///< runs that ended as completed or abandoned
  std::size_t num_retries = 0;    ///< runs started again after a crash, a hang or a NaN
  double busy_s = 0.0;            ///< of all workers together
};

/// Rules: a run that is completed or abandoned is never simulated again. Runs of one test setup ride
/// together in jobs of up to max_members; if such a job crashes or hangs, each of its runs is started
/// alone, so that a bad one never costs its neighbours. A run that crashes or hangs alone, gives a number
/// that is not finite, or comes back without having been run has used up one try. Every result is in the store before the next job of that worker is looked at.
/// @thread_safety one thread per object
class RunBroker {
 public:
  RunBroker(RunStore& store, WorkerPool& workers, BrokerOptions options);

  /// One record per identity, in order; state candidate: not run, because of a stop.
  /// @throws std::runtime_error if the store cannot be written or no worker can be started
  std::vector<RunRecord> run(std::span<const RunIdentity> wanted);

  const BrokerCounts& counts() const { return counts_; }

 private:
  using Job = std::vector<std::size_t>;  ///< places in the call's list: runs that ride together
  struct Call;
  /// Fills the call from the store. @return places of the runs to simulate
  std::vector<std::size_t> look_up(std::span<const RunIdentity> wanted, Call& call);
  std::vector<Job> plan(const std::vector<std::size_t>& missing,
                        const std::vector<RunRecord>& records) const;
  void count_try(RunRecord& record, const std::string& reason) const;
  void take_answer(const JobOutcome& outcome, const Job& job, Call& call) const;
  /// @return requests of runs that are started again
  std::vector<std::string> take_outcome(const JobOutcome& outcome, Call& call);
  RunStore& store_;
  WorkerPool& workers_;
  BrokerOptions options_;
  BrokerCounts counts_;
};

/// Members per job: as many as fit (max_members), but fewer where that leaves workers without a job.
std::size_t members_per_job(std::size_t num_members, int num_workers, int max_members);

/// Runs of one setup cut into jobs of `size`, those of the largest effort first; ties keep their order.
/// @param effort  of a run; may be empty: the order stays
std::vector<std::vector<std::size_t>> jobs_of_like_effort(std::vector<std::size_t> runs,
                                                          const std::function<double(std::size_t)>& effort,
                                                          std::size_t size);

}  // namespace tilth
