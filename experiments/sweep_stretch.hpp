// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Which part of a finite bin can be steady, from the tool's length and depth alone.
#pragma once

#include "experiments/sweep_tillage.hpp"

namespace tilth {

/// Places along the travel, from the front wall. Own choices; that they suffice is shown in
/// docs/experiments/sweep_tillage.md.
struct SweepStretch {
  double tool_length_m = 0.0;  ///< along the travel
  double travel_to_m = 0.0;    ///< the nose stops here: bin length - end clearance
  /// The whole tool and one depth more is in the bed when the nose is here: forces and tracers from
  /// here.
  double steady_from_m = 0.0;
  /// Here the tool has left the tracers half a depth behind when it stops.
  double tracers_to_m = 0.0;

  explicit SweepStretch(const SweepTillageConfig& config);
};

}  // namespace tilth
