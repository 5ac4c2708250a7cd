// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What every JSON file of a run folder says alike. Private to the *_json files.
#pragma once

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "calibrate/cli/file_hash.hpp"
#include "calibrate/cli/tool_info.hpp"
#include "experiments/field.hpp"

namespace tilth {

/// NaN is not JSON: null where a number is not known.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

inline nlohmann::ordered_json tool_json() {
  return {{"name", "tilth"},
          {"version", tool_version},
          {"commit", tool_commit},
          {"compiler", tool_compiler},
          {"flags", tool_flags}};
}

/// Numbers of a config or a material by name.
inline nlohmann::ordered_json fields_json(const std::vector<Field>& fields) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const Field& f : fields)
    std::visit([&](const auto* v) { object[std::string(f.name)] = *v; }, f.value);
  return object;
}

/// File names with their SHA-256.
inline nlohmann::ordered_json inputs_json(const std::vector<std::filesystem::path>& files) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& file : files)
    list.push_back({{"path", file.filename().string()}, {"sha256", sha256_of_file(file)}});
  return list;
}

}  // namespace tilth
