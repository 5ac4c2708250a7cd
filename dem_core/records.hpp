// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Per-contact numbers shared by all lanes, derived from Model when the neighbour list is built, and
// the features of a tool's mesh. Plain data: kernels include this file.
#pragma once

#include <cstdint>

namespace tilth {

/// Shared numbers of one listed pair, in the order the force loop reads them.
struct PairRecord {
  std::int32_t j = 0;
  std::int32_t bond = -1;           ///< index into Model::bonds, or -1
  double reference_m = 0.0;         ///< contact if the distance is below this
  double stiffness_factor = 0.0;    ///< k_n = contact_stiffness x this
  double damping_factor = 0.0;      ///< c_n = normal damping number x this
  double arm_offset_m = 0.0;        ///< (r_i - r_j) / 2
};

struct WallRecord {
  double reference_m = 0.0;
  double stiffness_factor = 0.0;
  double damping_factor = 0.0;
  bool glued = false;  ///< see WallReference
};

/// Points x of the body frame with normal . x - offset >= 0 (> 0 where the boundary is not included).
struct HalfSpace {
  double normal[3] = {0, 0, 0};
  double offset_m = 0.0;
  bool closed = true;
};

enum class FeatureKind : int { face, edge, vertex };

/// One feature. A grain touches it where the grain's centre lies in all its half spaces and nearer
/// than the grain's radius: to the plane through `point` with normal `direction` (face), to the line
/// through `point` along `direction` (edge), to `point` (vertex).
struct MeshFeature {
  FeatureKind kind = FeatureKind::face;
  double point_m[3] = {0, 0, 0};
  double direction[3] = {0, 0, 0};
  int half_space_begin = 0;
  int half_space_end = 0;
  double low_m[3] = {0, 0, 0};   ///< bounding box
  double high_m[3] = {0, 0, 0};
};

}  // namespace tilth
