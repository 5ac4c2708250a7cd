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

/// What "--soil all" means: soils that are fitted with the same parameters, so that they can be pooled and compared.
struct SoilsOfOneKind {
  std::vector<std::string> soils;     ///< of several such groups the largest, in alphabetical order
  std::vector<std::string> left_out;  ///< a sentence for each of the others
};
/// A soil that cannot be read is among `soils`, so that its mistakes come to light.
SoilsOfOneKind soils_of_one_kind();

/// The soils of soils_of_one_kind(). Who is left out is told on standard error.
std::vector<std::string> soils_of_all();

/// The tables of a soil folder that are there: what a result depends on.
std::vector<std::filesystem::path> soil_tables(const std::filesystem::path& folder);

}  // namespace tilth
