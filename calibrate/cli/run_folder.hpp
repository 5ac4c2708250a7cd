// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The output folder: made before anything is computed, files appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace tilth {

/// Makes the folder and checks that it can be written. An existing folder that is not empty is
/// moved to "<folder>.backup-<date>-<time>" first. An empty name becomes runs/<stem>-<n> with the
/// first free n.
/// @throws ConfigError if it cannot be made or written
std::filesystem::path make_run_folder(const std::filesystem::path& wanted, const std::string& stem);

/// Writes beside and renames. Folders on the way are made.
/// @throws std::runtime_error with the path
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace tilth
