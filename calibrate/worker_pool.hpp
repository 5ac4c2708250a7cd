// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Jobs for worker processes: a crash or a hang costs one job, not the program.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibrate/worker_process.hpp"

namespace tilth {

/// How far a pool shall go on.
enum class StopWish {
  none,
  finish_running,  ///< start nothing new, wait for what runs
  at_once,         ///< kill what runs
};

enum class JobEnd { answered, crashed, overdue };

struct JobOutcome {
  std::size_t job = 0;  ///< as numbered by run()
  JobEnd end = JobEnd::crashed;
  std::string answer;   ///< the line, if answered
  std::string reason;   ///< of a crash or an overdue job, with the worker's last words
  double wall_s = 0.0;
};

/// Processes that are started when needed, kept for further jobs, and replaced when they die. A worker
/// says "ready" before anything else; one that dies earlier is no fault of its job, which is started
/// again.
/// @thread_safety one thread per object
class WorkerPool {
 public:
  WorkerPool(std::vector<std::string> command, int num_workers);

  /// Called for every job that ended; what it returns are requests of further jobs, numbered on.
  using OnEnd = std::function<std::vector<std::string>(const JobOutcome&)>;

  /// Runs jobs 0, 1, ... in this order over the workers until all have ended or a stop is wished.
  /// Jobs cut short by a stop are not reported.
  /// @param limit_s  a job that takes longer is overdue: its worker is killed
  /// @param stop     asked ten times a second
  /// @throws std::runtime_error if no worker can be started, or three in a row die before they are ready
  void run(std::vector<std::string> requests, double limit_s,
           const std::function<StopWish()>& stop, const OnEnd& on_end);

  int num_workers() const { return num_workers_; }

 private:
  struct Seat;
  struct Round;
  void start_next(Round& round, Seat& seat);
  void look_after(Round& round, Seat& seat);
  void finish(Round& round, Seat& seat, JobOutcome outcome);
  void lost_before_ready(Round& round, Seat& seat, const std::string& reason);
  std::vector<std::string> command_;
  int num_workers_;
  int num_early_deaths_ = 0;
  std::vector<WorkerProcess> idle_;
};

}  // namespace tilth
