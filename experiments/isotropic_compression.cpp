// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/isotropic_compression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem_core/time_step.hpp"

namespace tilth {
namespace {

constexpr int max_intervals = 6000;
constexpr double steady_inertial_times = 2.5;

}  // namespace

void IsotropicCompression::start(LaneRun& run, int lane) {
  const double rate_per_s = inertial_number / inertial_time_s(run);
  for (int axis = 0; axis < 3; ++axis)
    hold_box_stress(run, lane, axis, stress_Pa_, rate_per_s * box_size_m(run, lane)[axis]);
  void_ratio_ = void_ratio(run, lane);
}

double IsotropicCompression::inertial_time_s(const LaneRun& run) const {
  return 2 * run.specimen.mean_radius_m * std::sqrt(density_kg_per_m3_ / stress_Pa_);
}

bool IsotropicCompression::advance(LaneRun& run, int lane) {
  const double e = void_ratio(run, lane);
  bool steady = std::abs(e - void_ratio_) < 2e-5;
  void_ratio_ = e;
  for (int axis = 0; axis < 3; ++axis) {
    steady = steady && std::abs(box_stress_Pa(run, lane, axis) - stress_Pa_) < 0.01 * stress_Pa_;
    update_box_stress(run, lane, axis, stress_Pa_);
  }
  steady_s_ = steady ? steady_s_ + interval_steps * run.dt_s(lane) : 0.0;
  if (steady_s_ >= steady_inertial_times * inertial_time_s(run)) return true;
  if (++num_intervals_ >= max_intervals)
    run.finish(lane, RunStatus::not_settled,
               fmt::format("isotropic stress did not settle at {:.4g} Pa: {:.4g}, {:.4g}, {:.4g} Pa",
                           stress_Pa_, box_stress_Pa(run, lane, 0), box_stress_Pa(run, lane, 1),
                           box_stress_Pa(run, lane, 2)));
  return false;
}

double cloud_time_step_s(const Model& model, int lane) {
  const LaneLaw& law = model.lanes[static_cast<std::size_t>(lane)];
  const auto smallest = std::ranges::min_element(model.radius_m) - model.radius_m.begin();
  const double r = model.radius_m[static_cast<std::size_t>(smallest)];
  const double m = model.mass_kg[static_cast<std::size_t>(smallest)];
  const double kn =
      law.contact_stiffness * stiffness_bound(law.effects) * std::numbers::pi * r / 2;
  const double translation = (1 + 2 * law.shear_stiffness_ratio) / 3;
  const double rotation = 2.0 / 3.0 * law.shear_stiffness_ratio / 0.4;
  const double k = 2 * 12 * kn * std::max(translation, rotation) / m;
  return ladder_time_step_s(0.8 * 2 / std::sqrt(k));
}

}  // namespace tilth
