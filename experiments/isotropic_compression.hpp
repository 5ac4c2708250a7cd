// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A cloud of grains pressed together from all sides: how unbonded specimens are made.
#pragma once

#include "experiments/triaxial_box.hpp"

namespace tilth {

/// Presses the specimen of a lane to an isotropic stress by the three upper plates of its box.
///
/// The plates close at most at the speed whose inertial number I = (v / size) 2 r sqrt(rho / p) is
/// `inertial_number`. Settled: all three stresses within 1 % of p, and the void ratio within 2e-5 of
/// what it was an interval before, for 2.5 inertial times 2 r sqrt(rho / p) on end.
/// @source own choice; the void ratio it leads to falls with friction, as known from isotropic
///         compression of spheres (Agnolin & Roux, Phys. Rev. E 76 (2007) 061302)
class IsotropicCompression {
 public:
  static constexpr int interval_steps = 50;
  static constexpr double inertial_number = 0.01;

  IsotropicCompression(double stress_Pa, double density_kg_per_m3)
      : stress_Pa_(stress_Pa), density_kg_per_m3_(density_kg_per_m3) {}

  void start(LaneRun& run, int lane);
  /// Once per interval; true when settled. Ends the lane as not_settled after max_intervals.
  bool advance(LaneRun& run, int lane);
  /// Counts the steady intervals anew, after something was changed.
  void settle_again() { steady_s_ = 0.0; }
  /// 2 r sqrt(rho / p): what a grain takes to move by its own size under the stress.
  double inertial_time_s(const LaneRun& run) const;

 private:
  double stress_Pa_;
  double density_kg_per_m3_;
  double void_ratio_ = 0.0;
  int num_intervals_ = 0;
  double steady_s_ = 0.0;
};

/// A time step for a cloud whose contacts are still to come: 0.8 of the bound of docs/theory/time_step.md
/// for the smallest grain with 12 neighbours of its own size all around it, on the ladder.
///   k = 2 * 12 k_n max((1 + 2 / kappa) / 3, (2 / (3 kappa)) / 0.4) / m,   k_n = E_c pi r / 2
double cloud_time_step_s(const Model& model, int lane);

}  // namespace tilth
