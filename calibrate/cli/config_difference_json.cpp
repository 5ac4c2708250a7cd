// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calibrate/cli/config_difference.hpp"
#include "calibrate/cli/run_session.hpp"
#include "calibrate/cli/tool_info.hpp"

namespace tilth {
namespace {

using Json = nlohmann::json;

Json flattened(const std::string& text) {
  Json config = Json::parse(text, nullptr, false);
  if (!config.is_object()) return Json::object();
  config.erase("tool");
  if (config.contains("fit")) config["fit"].erase("max_simulations");
  return config.flatten();
}

std::string shown(const Json& object, const std::string& key) {
  return object.contains(key) ? object.at(key).dump() : "nothing";
}

}  // namespace

std::vector<std::string> config_differences(const std::string& there, const std::string& here) {
  const Json a = flattened(there), b = flattened(here);
  std::vector<std::string> keys, found;
  for (const auto& [key, value] : a.items()) keys.push_back(key);
  for (const auto& [key, value] : b.items())
    if (!a.contains(key)) keys.push_back(key);
  for (const std::string& key : keys)
    if (shown(a, key) != shown(b, key))
      found.push_back(fmt::format("{}: {} there, {} here", key, shown(a, key), shown(b, key)));
  return found;
}

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
