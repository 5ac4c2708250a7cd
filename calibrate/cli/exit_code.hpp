// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The one list of exit codes.
#pragma once

namespace tilth {

enum ExitCode : int {
  exit_done = 0,             ///< done, result usable, all gates passed
  exit_internal = 1,         ///< a bug, a full disk, a locked file
  exit_bad_input = 2,
  exit_budget = 3,           ///< budget or signal ended it; the report is valid
  exit_unreachable = 4,      ///< done, but a target is not reachable by the model
  exit_failed_runs = 5,      ///< too many failed runs
  exit_holdout_failed = 6    ///< done, but the hold-out criterion failed
};

}  // namespace tilth
