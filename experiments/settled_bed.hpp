// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Loose grains under gravity: from a packing to a bed, and when a bed counts as settled.
#pragma once

#include <span>

#include "experiments/lane_run.hpp"

namespace tilth {

/// How loose grains are let settle. Gravity points to -z.
struct LooseBedSpec {
  double gravity_m_per_s2 = 9.81;
  double depth_m = 0.1;  ///< of the bed; with its own grain density it sets the modulus
  /// E_c of every member is this number x rho g depth; 0 takes the member's own. A grain at the bottom is
  /// then pressed by some 2.5 (1 - porosity) / number of its radius: 0.2 % at 700.
  double stiffness_over_weight = 700;
  double restitution = 0.5;    ///< of head-on impacts, in (0, 1]; the tangential dashpot has k_s / k_n of it
  double local_damping = 0.0;  ///< instead of the member's
  int num_fixed = 0;           ///< the first grains of the packing do not move
};

/// Lanes = materials, without bonds; walls are greased, contacts count from the radii. The time step is
/// 0.8 of the stable bound of the smallest grain among eight equal neighbours, snapped down to the ladder:
/// a bed that is still to settle has few contacts, so its own bound would be too long.
Specimen make_loose_bed(const Packing& packing, std::span<const SoilMaterial> materials,
                        const std::vector<Wall>& walls, const LooseBedSpec& spec);

/// Mean kinetic energy of translation of the grains that may move over (mean mass) g (mean radius). Spin
/// does not count: nothing resists twisting about a normal, so that a grain between greased walls may
/// spin in its place for ever, which leaves the bed as it is.
double agitation(const LaneRun& run, int lane);

/// Largest height of a grain's top above z = 0.
double bed_height_m(const LaneRun& run, int lane);

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
