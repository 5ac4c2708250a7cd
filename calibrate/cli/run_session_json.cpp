// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/cli/run_session.hpp"

namespace tilth {

std::string RunSession::timing_json(const std::string& command_line) const {
  const BrokerCounts& c = counts();
  nlohmann::ordered_json timing = {{"schema", "tilth.timing/1"},
                                   {"command", command_line},
                                   {"commit", tool_commit},
                                   {"workers", num_workers()},
                                   {"wall_s", seconds()},
                                   {"worker_s", c.busy_s},
                                   {"runs_simulated", c.num_simulated},
                                   {"runs_from_store", c.num_from_store},
                                   {"runs_retried", c.num_retries}};
  return timing.dump(2) + "\n";
}

}  // namespace tilth
