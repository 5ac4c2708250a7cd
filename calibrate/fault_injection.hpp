// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Faults on order, to try out that none of them costs a result. For tests.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calibrate/run_record.hpp"

namespace tilth {

/// Shares of runs that go wrong once, the first time they are started:
/// TILTH_FAULTS="crash=0.1,hang=0.05,nan=0.05,dir=/tmp/x". Which runs is decided by their key; a mark in
/// `dir` (a folder that exists) remembers who has had it, also over a restart of the program.
struct Faults {
  double crash = 0.0, hang = 0.0, nan = 0.0;
  std::filesystem::path folder;

  enum class Kind { none, crash, hang, nan };
  /// What happens to this run now; marks it.
  Kind next(const std::string& key) const;
};

/// From the environment; empty without the variable.
/// @throws std::runtime_error if the variable cannot be read
std::optional<Faults> faults_on_order();

/// Applies the fault of one run: does not return from a crash or a hang, spoils the record's features
/// for NaN.
void suffer(Faults::Kind fault, RunRecord& record);

}  // namespace tilth
