// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/soil_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>

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

SoilsOfOneKind soils_of_one_kind() {
  std::map<std::vector<std::string>, std::vector<std::string>> kinds;
  SoilsOfOneKind all;
  for (const std::string& name : known_soils(data_root())) {
    try {
      std::vector<std::string> free;
      for (const SoilParameter& p : load_soil(soil_folder(data_root(), name)).parameters)
        if (p.estimate) free.push_back(p.id);
      std::ranges::sort(free);
      kinds[free].push_back(name);
    } catch (const ConfigError&) {
      all.soils.push_back(name);
    }
  }
  const auto largest = std::ranges::max_element(kinds, {}, [](const auto& kind) { return kind.second.size(); });
  for (auto kind = kinds.begin(); kind != kinds.end(); ++kind)
    for (const std::string& name : kind->second) {
      if (kind == largest) all.soils.push_back(name);
      else
        all.left_out.push_back(fmt::format("{}: left out of --soil all, it is fitted with other parameters ({})", name,
                                           fmt::join(kind->first, ", ")));
    }
  std::ranges::sort(all.soils);
  return all;
}

std::vector<std::string> soils_of_all() {
  const SoilsOfOneKind kind = soils_of_one_kind();
  for (const std::string& sentence : kind.left_out) std::cerr << sentence << '\n';
  return kind.soils;
}

std::vector<std::filesystem::path> soil_tables(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const char* name :
       {"soil.json", "conditions.csv", "measurements.csv", "parameters.csv", "curves.csv", "tracers.csv"})
    if (std::filesystem::exists(folder / name)) files.push_back(folder / name);
  return files;
}

}  // namespace tilth
