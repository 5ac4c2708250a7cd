// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The other end of a WorkerPool.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "calibrate/run_record.hpp"

namespace tilth {

/// Simulates members of one test setup: one record per identity, completed or abandoned.
using MemberSimulator = std::function<std::vector<RunRecord>(std::span<const RunIdentity>)>;

/// Says "ready", then answers requests (run_message.hpp) line by line until standard input ends. The
/// process dies with its parent, ignores Ctrl-C (its parent decides), and suffers TILTH_FAULTS.
/// @return exit code of the worker
int run_worker(const MemberSimulator& simulate);

}  // namespace tilth
