// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Faces, edges and vertices of a mesh with their Voronoi regions: who acts on a grain.
#pragma once

#include <vector>

#include "dem_core/model.hpp"
#include "dem_core/records.hpp"

namespace tilth {

struct MeshFeatures {
  std::vector<MeshFeature> features;  ///< faces, then edges, then vertices
  std::vector<HalfSpace> half_spaces;
};

/// Regions that never overlap and leave no gap outside a convex part of the surface:
///   face:   the prism over the triangle;
///   edge:   between the two adjacent prisms and the planes through its ends, where the edge is convex;
///   vertex: behind the end planes of all edges that meet in it, where that cone is open and outside.
/// Coplanar (within 1e-6 rad) and concave edges have empty regions and are left out, so a flat
/// triangulated plate acts as one plane and a concave corner as its two faces. A boundary point
/// belongs to the side it would lie on after a shift along one fixed skew direction: always one, where its numbers are exact
/// (rounding may leave a slit or an overlap of 1e-16 between skew faces).
/// @pre problems(mesh) is empty
/// @source derived here; the outside of a vertex by its angle-weighted normal as in Baerentzen &
///         Aanaes, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243-253
MeshFeatures mesh_features(const Mesh& mesh);

}  // namespace tilth
