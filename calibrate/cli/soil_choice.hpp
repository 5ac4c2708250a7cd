// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Which soil a command is about.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tilth {

/// $TILTH_DATA, or the data folder of the source tree this program was built from.
std::filesystem::path data_root();

/// The folder of --data, else of --soil under data_root(). @throws ConfigError
std::filesystem::path chosen_soil_folder(const std::string& soil, const std::string& folder);

/// Names of the soils under data_root() that have a tracers.csv: what "--soil all" means.
std::vector<std::string> soils_with_tracers();

/// The tables of a soil folder that are there: what a result depends on.
std::vector<std::filesystem::path> soil_tables(const std::filesystem::path& folder);

}  // namespace tilth
