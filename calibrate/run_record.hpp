// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// One simulation on record: what was asked, how it ended, what it gave.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tilth {

/// Where a simulation stands. Only the last three are kept in a store; the others live while a
/// program runs, and a run that was under way when the program died is a candidate again.
enum class RunState {
  candidate,  ///< proposed, not started
  running,    ///< started, no result yet
  overdue,    ///< past its time limit; its worker is killed and the run counts as failed once
  completed,  ///< result valid, all numbers finite
  failed,     ///< no valid result, for a reason that may pass (crash, hang, NaN): will be tried again
  abandoned,  ///< never to be tried again: it fails the same way each time, or has used up its tries
};
/// "CANDIDATE", "RUNNING", ...
std::string_view to_string(RunState state);

struct NamedNumber {
  std::string name;
  double value = 0.0;
};

/// Columns of equal length.
struct NamedTable {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

/// What decides the result of a simulation, and nothing else.
struct RunIdentity {
  std::string solver;     ///< version of everything that computes
  std::string test;       ///< "direct_shear"
  std::string condition;  ///< conditionId of the soil's tables; for people, not part of the key
  std::uint64_t seed = 0;
  std::string setup;      ///< "name=value\n" of every number of the test, in its own order
  std::string material;   ///< the same of the material
};

/// SHA-256 over solver, test, setup (which holds the seed) and material, as 64 hexadecimal digits.
/// Equal keys mean equal results, bit for bit.
std::string run_key(const RunIdentity& identity);

struct RunRecord {
  std::string key;
  RunIdentity identity;
  RunState state = RunState::candidate;
  /// How it ended, in words. Of a virtual test "<status>: <message>" whether it completed or not, which
  /// calibrate/cli/test_runs.cpp reads back; a plain sentence where no result came (crash, hang, refusal).
  std::string reason;
  int num_tries = 0;
  double dt_s = 0.0;
  std::int64_t num_steps = 0;
  double inertial_number = 0.0;
  double wall_s = 0.0;  ///< of its job over the members of the job
  std::string host;
  std::vector<NamedNumber> features;  ///< empty unless completed
  std::vector<NamedTable> curves;
};

}  // namespace tilth
