// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes in STL files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dem_core/mesh.hpp"

namespace tilth {

/// Reads an ASCII or binary STL file; the two are told apart by the binary form's length,
/// 84 + 50 n bytes. Corners with equal coordinates are merged; the normals of the file are ignored,
/// the order of the corners counts. Triangles are counted from 0, in the file's order.
///
/// Repaired, because only one solid can be meant: a triangle two of whose corners are one point is left
/// out; a closed, consistent surface that faces inwards all over is turned. Everything else is refused.
/// @param metres_per_unit  1e-3 for a file in millimetres (STL itself knows no unit)
/// @param repairs  receives one sentence for each kind of repair; may be absent
/// @throws std::runtime_error naming the file and the triangle: unreadable, not STL, cut off, a corner
///         that is not finite, a triangle without area, or problems()
Mesh read_stl(const std::filesystem::path& file, double metres_per_unit,
              std::vector<std::string>* repairs = nullptr);

/// Writes ASCII STL in metres, 17 digits, so that reading it back gives the same numbers.
/// @throws std::runtime_error if the file cannot be written
void write_stl(const Mesh& mesh, const std::filesystem::path& file);

}  // namespace tilth
