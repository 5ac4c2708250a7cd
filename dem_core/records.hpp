// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Per-contact numbers shared by all lanes, derived from Model when the neighbour list is built.
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

}  // namespace tilth
