// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_worker.hpp"

#include <cstdlib>
#include <filesystem>

#include "calibrate/cli/solver_version.hpp"
#include "calibrate/cli/test_runs.hpp"
#include "calibrate/worker_loop.hpp"

namespace tilth {

void add_worker_options(CLI::App& command, WorkerOptions& o) {
  command.add_option("--lanes", o.max_lanes, "at most this many parameter sets per pack: 1, 4 or 8")
      ->check(CLI::IsMember({0, 1, 4, 8}));
}

int run_worker_command(const WorkerOptions& o) {
  PackingStore packings(default_packing_folder(), solver_version);
  return run_worker([&](std::span<const RunIdentity> members) {
    return simulate_members(members, packings, o.max_lanes);
  });
}

std::vector<std::string> worker_command(int max_lanes) {
  const char* other = std::getenv("TILTH_WORKER_PROGRAM");  // for tests, which are no such program
  return {other ? other : std::filesystem::read_symlink("/proc/self/exe").string(), "worker", "--lanes",
          std::to_string(max_lanes)};
}

}  // namespace tilth
