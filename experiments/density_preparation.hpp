// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Unbonded specimens of a given relative density, on the loosest and densest states of the spheres.
#pragma once

#include "experiments/batch.hpp"
#include "experiments/isotropic_compression.hpp"

namespace tilth {

/// The states a cloud of spheres can itself be prepared in at one isotropic stress.
///
///   loosest: pressed together from a cloud with the friction the grains have;
///   densest: then the friction is taken away under that stress.
/// I_D = (e_max - e) / (e_max - e_min).
struct OwnStates {
  double loosest_void_ratio = 0.0;
  double densest_void_ratio = 0.0;

  double relative_density(double void_ratio) const {
    return (loosest_void_ratio - void_ratio) / (loosest_void_ratio - densest_void_ratio);
  }
  double void_ratio(double relative_density) const {
    return loosest_void_ratio - relative_density * (loosest_void_ratio - densest_void_ratio);
  }
};

/// Prepares one lane: press with its friction (the loosest state is measured on this very specimen),
/// without rolling friction and effects, which would make it looser and stand for density;
/// lower ln(friction) by 0.2 per inertial time (isotropic_compression.hpp) until the void ratio is that of the relative density, give
/// friction, rolling friction and effects back, settle. Local damping is 0.2 meanwhile. A relative density off by more than 0.25
/// fails the lane, unless 0.75 or more was asked for and the specimen came to rest without friction: it
/// is as dense as it gets, and its relative density on the cloud's mean states is reported as it is.
/// @source own choice; friction as the handle on density is common in DEM work
class DensityPreparation {
 public:
  /// @param relative_density in [0, 1]; 1 takes the friction away and settles
  DensityPreparation(double relative_density, double densest_void_ratio, double stress_Pa,
                     const SoilMaterial& material);

  void start(LaneRun& run, int lane);
  /// Once per interval; true when the specimen is ready, with its own friction.
  bool advance(LaneRun& run, int lane);
  const OwnStates& states() const { return states_; }

 private:
  enum class Stage { press, densify, settle };
  bool densify(LaneRun& run, int lane, bool settled);

  double relative_density_;
  double own_friction_;
  double own_damping_;
  double own_rolling_friction_ = 0.0;
  EffectLaw own_effects_;
  double friction_;
  OwnStates states_;
  IsotropicCompression press_;
  Stage stage_ = Stage::press;
};

/// Void ratio of the densest state of a cloud against stress over contact modulus p/E_c: the parabola
/// c0 + c1 x + c2 x^2 by least squares through eight states between p/E_c of 2.5e-4 and 24e-3. A single
/// state is a matter of chance (200 spheres scatter by 0.012, a tenth of the range of densities), their
/// mean course is not. Outside the range the value at its end.
struct DensestStates {
  RunStatus status = RunStatus::stopped;  ///< anything but completed: there are no states
  std::string message;
  std::vector<double> coefficients;  ///< c0, c1, c2

  double void_ratio_at(double ratio) const;
};

/// The densest states of a cloud by the procedure above, with friction 0.5; measured once per store.
/// @cost one pack of eight lanes: about 5 core-seconds with 200 spheres, 20 with 600
DensestStates densest_states(PackingStore& packings, const PackingSpec& cloud,
                             const RunOptions& options);

}  // namespace tilth
