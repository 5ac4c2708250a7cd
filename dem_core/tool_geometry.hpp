// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Where a tool meets a point, one lane; the same formulas as the kernel's.
#pragma once

#include <optional>

#include "dem_core/state.hpp"

namespace tilth {

/// World point in the body frame of the tool as placed in `lane`.
Vec3 to_body_frame(const State& state, int tool, const Vec3& point_m, int lane = 0);

/// Where a feature meets a point.
struct FeatureDistance {
  double distance_m = 0.0;     ///< from the feature, negative behind a face
  Vec3 normal = Vec3::Zero();  ///< body frame, from the tool to the point
};

/// Distance to one feature, or nothing where the point is `margin_m` outside of the feature's region
/// or `reach_m` or more away.
/// @param in_body_m  the point in the body frame
std::optional<FeatureDistance> feature_distance(const MeshFeatures& mesh, std::size_t feature,
                                                const Vec3& in_body_m, double reach_m,
                                                double max_depth_m, double margin_m = 0.0);

/// Distance from the tool, placed as at its start, to a point; reach_m where it is that far or more
/// away, or further than max_depth_m behind every face.
/// @param mesh  mesh_features(tool.mesh)
double tool_distance_m(const Tool& tool, const MeshFeatures& mesh, const Vec3& point_m,
                       double reach_m);

/// Largest distance of a vertex from the body frame's origin.
double tool_extent_m(const Tool& tool);

}  // namespace tilth
