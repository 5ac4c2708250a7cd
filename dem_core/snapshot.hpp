// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Saving and restoring a State, bit for bit.
#pragma once

#include <filesystem>

#include "dem_core/state.hpp"

namespace tilth {

/// Writes the whole State (native doubles, little-endian processors only) to a file beside the
/// target and renames it. Continuing from the file gives the bits of never having stopped.
/// @throws std::runtime_error with the path if the file cannot be written
void save_snapshot(const State& state, const std::filesystem::path& file);

/// @throws std::runtime_error with the path if the file is absent, damaged or of another version
State load_snapshot(const std::filesystem::path& file);

}  // namespace tilth
