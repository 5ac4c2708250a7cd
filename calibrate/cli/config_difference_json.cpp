// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "calibrate/cli/config_difference.hpp"

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

}  // namespace tilth
