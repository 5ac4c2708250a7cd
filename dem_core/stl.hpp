// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes in STL files.
#pragma once

#include <filesystem>

#include "dem_core/mesh.hpp"

namespace tilth {

/// Reads an ASCII or binary STL file; the two are told apart by the binary form's length,
/// 84 + 50 n bytes. Corners with equal coordinates are merged; the normals of the file are ignored,
/// the order of the corners counts.
/// @param metres_per_unit  1e-3 for a file in millimetres (STL itself knows no unit)
/// @throws std::runtime_error naming the file: unreadable, not STL, cut off, not finite, or problems()
Mesh read_stl(const std::filesystem::path& file, double metres_per_unit);

/// Writes ASCII STL in metres, 17 digits, so that reading it back gives the same numbers.
/// @throws std::runtime_error if the file cannot be written
void write_stl(const Mesh& mesh, const std::filesystem::path& file);

}  // namespace tilth
