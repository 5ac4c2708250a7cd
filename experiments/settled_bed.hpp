// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Grains under gravity: when a bed counts as settled.
#pragma once

#include "experiments/lane_run.hpp"

namespace tilth {

/// Mean kinetic energy of the grains over (mean mass) g (mean radius).
double agitation(const LaneRun& run, int lane);

/// Says when a bed is at rest: its agitation has stayed below a limit for some intervals.
class CalmWatch {
 public:
  CalmWatch(double limit, int num_intervals) : limit_(limit), num_intervals_(num_intervals) {}
  /// Call once per interval.
  bool calm(double agitation) {
    num_calm_ = agitation < limit_ ? num_calm_ + 1 : 0;
    return num_calm_ >= num_intervals_;
  }
  void begin_again() { num_calm_ = 0; }

 private:
  double limit_;
  int num_intervals_;
  int num_calm_ = 0;
};

}  // namespace tilth
