// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Closed triangle meshes: the shape of a rigid tool.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dem_core/model.hpp"

namespace tilth {

/// Everything wrong with a mesh as the surface of a solid, one sentence each; empty means usable.
///
/// Closed and consistently oriented: every directed edge a -> b belongs to one triangle and b -> a to
/// another. Outward: the enclosed volume is positive. No triangle is degenerate: its height over its
/// longest side is above 1e-9 of that side. At most three sentences of each kind.
std::vector<std::string> problems(const Mesh& mesh);

/// Enclosed volume, positive where the triangles are seen counter-clockwise from outside:
///   V = sum a . (b x c) / 6
/// @source divergence theorem
double mesh_volume_m3(const Mesh& mesh);

/// Unit normal of a triangle, outward.
Vec3 triangle_normal(const Mesh& mesh, std::size_t triangle);

/// A mesh from a soup of triangles: corners with equal coordinates become one vertex.
Mesh merge_vertices(const std::vector<std::array<Vec3, 3>>& triangles);

}  // namespace tilth
