// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Every simulation of a fit in one SQLite file, keyed by content.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibrate/run_record.hpp"

namespace tilth {

/// A file of RunRecords (docs/store.md has the tables, for SQL and Python).
///
/// A batch of records is one transaction: after a crash, a SIGKILL or a full disk the file holds all
/// of it or none. Several programs may use one file at once; each waits for the other's write. A
/// record that is there already is not written twice: a completed or abandoned one stays, a failed
/// one is replaced.
/// @thread_safety one thread per object
class RunStore {
 public:
  enum class Mode {
    read_only,
    read_write,  ///< of a file that is there
    make,        ///< the same, and makes the file if it is not there
  };

  /// @throws ConfigError if it is no store, of another format, absent (unless make), or not writable
  explicit RunStore(const std::filesystem::path& file, Mode mode = Mode::make);
  ~RunStore();
  RunStore(RunStore&&) noexcept;

  std::optional<RunRecord> find(const std::string& key) const;
  /// Not there, or there as failed only: a record of this key would be taken.
  bool lacks(const std::string& key) const;
  /// @throws std::runtime_error with file and reason (disk full, locked for 60 s); nothing is half-written
  void add(std::span<const RunRecord> records);

  /// One line per solver and test.
  struct Count {
    std::string solver;
    std::string test;
    std::size_t num_completed = 0, num_failed = 0, num_abandoned = 0;
    double wall_s = 0.0;  ///< of all of them
  };
  std::vector<Count> counts() const;
  /// Keys that begin with `prefix`, in order of entry.
  std::vector<std::string> keys(const std::string& prefix = "") const;
  /// Records that were offered although they were there already: simulated twice for nothing.
  std::size_t num_repeats() const;

  /// What to remove; empty strings match everything.
  struct Selection {
    std::string solver_not{};  ///< records of any other solver version than this
    std::string test{};
    std::string key_prefix{};
    bool only_failed = false;  ///< failed and abandoned ones
  };
  /// @return number of records removed
  std::size_t remove(const Selection& selection);
  /// Takes over what `other` has and this one lacks. @return number of records taken
  std::size_t merge(const RunStore& other);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tilth
