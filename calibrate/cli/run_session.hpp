// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What every long command shares: its folder, store and workers, and when to stop.
#pragma once

#include <CLI/App.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/test_runs.hpp"

namespace tilth {

struct SessionOptions {
  std::string out;
  std::string store;         ///< evaluation store; empty: evaluations.sqlite in the run folder
  bool resume = false;
  std::string max_walltime;  ///< Slurm notation; empty: none
  double run_timeout_s = 1800;
  int num_threads = 0;       ///< 0: all processors
  int max_lanes = 0;         ///< 0: what the processor offers
};

void add_session_options(CLI::App& app, SessionOptions& options);

/// Everything wrong with them, one sentence each.
std::vector<std::string> problems(const SessionOptions& options);

/// The run folder of a command: a fresh one (an existing one is moved to a dated backup), or with
/// --resume the one that is there, if its config.json says the same but for tool and budgets.
/// @param config_text  config.json of this run; written
/// @throws ConfigError listing what differs, or if the folder cannot be written
std::filesystem::path open_run_folder(const SessionOptions& options, const std::string& stem,
                                      const std::string& config_text);

/// Store, workers and stop rules of one command in one folder.
///
/// Ends early at once: Ctrl-C, SIGTERM, --max-walltime. Ends after the running jobs: a file STOP in the folder. A
/// STOP file that is there at the start is removed: it was for an earlier run.
/// @limits one program per folder (a lock says so), many programs per store
class RunSession {
 public:
  /// @throws ConfigError if the folder is in use or the store cannot be opened
  RunSession(const SessionOptions& options, const std::filesystem::path& folder);

  const RunContext& context() const { return context_; }
  StopWish wish() const;
  bool should_stop() const { return wish() != StopWish::none; }
  /// "--max-walltime 10:00 reached", "stopped by a signal", ...; empty while nothing asks for it.
  std::string stop_reason() const;
  const BrokerCounts& counts() const { return broker_->counts(); }
  int num_workers() const { return workers_->num_workers(); }
  double seconds() const;
  /// timing.json: what this start of the command cost; never part of a result.
  std::string timing_json(const std::string& command_line) const;
  /// What the store holds that this solver cannot use; empty if nothing.
  std::string store_note() const;

 private:
  std::filesystem::path folder_;
  std::optional<double> walltime_s_;
  std::string walltime_text_;
  std::chrono::steady_clock::time_point start_;
  FolderLock lock_;
  PackingStore packings_;
  std::unique_ptr<RunStore> store_;
  std::unique_ptr<WorkerPool> workers_;
  std::unique_ptr<RunBroker> broker_;
  RunContext context_;
};

}  // namespace tilth
