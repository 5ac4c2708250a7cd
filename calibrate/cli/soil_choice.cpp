// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/soil_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

#include "calibrate/cli/tool_info.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/soil_data.hpp"

namespace tilth {

std::filesystem::path data_root() {
  const char* value = std::getenv("TILTH_DATA");
  return value && *value ? value : default_data_root;
}

std::filesystem::path chosen_soil_folder(const std::string& soil, const std::string& folder) {
  if (!folder.empty()) {
    if (!std::filesystem::is_directory(folder))
      throw ConfigError({fmt::format("--data {}: is not a folder", folder)});
    return folder;
  }
  if (soil.empty())
    throw ConfigError({fmt::format("--soil is missing: one of {}, or --data FOLDER",
                                   fmt::join(known_soils(data_root()), ", "))});
  return soil_folder(data_root(), soil);
}

std::vector<std::string> soils_with_tracers() {
  std::vector<std::string> found;
  for (const std::string& soil : known_soils(data_root()))
    if (std::filesystem::exists(soil_folder(data_root(), soil) / "tracers.csv")) found.push_back(soil);
  return found;
}

std::vector<std::filesystem::path> soil_tables(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const char* name :
       {"soil.json", "conditions.csv", "measurements.csv", "parameters.csv", "curves.csv", "tracers.csv"})
    if (std::filesystem::exists(folder / name)) files.push_back(folder / name);
  return files;
}

}  // namespace tilth
