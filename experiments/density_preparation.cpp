// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/density_preparation.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tilth {
namespace {

constexpr double friction_decay = 0.12;    ///< of ln(friction) per inertial time
/// Stronger damping lets the friction run ahead of the grains: targets of 0.80 came out as 0.87.
constexpr double preparation_damping = 0.2;
constexpr double frictionless = 2e-3;      ///< below it friction is taken away altogether
constexpr double tolerance = 0.15;         ///< of relative density, above which a lane fails

}  // namespace

DensityPreparation::DensityPreparation(double relative_density, double densest_void_ratio,
                                       double stress_Pa, const SoilMaterial& material)
    : relative_density_(relative_density),
      own_friction_(material.friction),
      own_damping_(material.local_damping),
      friction_(material.friction),
      states_{0.0, densest_void_ratio},
      press_(stress_Pa, material.density_kg_per_m3) {}

void DensityPreparation::start(LaneRun& run, int lane) {
  set_time_step(run, lane, cloud_time_step_s(run.specimen.model, lane));
  set_local_damping(run, lane, preparation_damping);
  press_.start(run, lane);
}

bool DensityPreparation::densify(LaneRun& run, int lane) {
  if (void_ratio(run, lane) <= states_.void_ratio(relative_density_)) return true;
  friction_ *= std::exp(-friction_decay * IsotropicCompression::interval_steps * run.dt_s(lane) /
                        press_.inertial_time_s(run));
  if (friction_ < frictionless) friction_ = 0.0;
  set_friction(run, lane, friction_);
  return friction_ == 0.0;
}

bool DensityPreparation::advance(LaneRun& run, int lane) {
  const bool settled = press_.advance(run, lane);
  if (!run.active(lane)) return false;
  if (stage_ == Stage::press && settled) {
    states_.loosest_void_ratio = void_ratio(run, lane);
    stage_ = Stage::densify;
  }
  if (stage_ == Stage::densify && densify(run, lane)) {
    // At the densest state grains settle without friction first; it is given back at the end.
    if (friction_ > 0.0) set_friction(run, lane, own_friction_);
    press_.settle_again();
    stage_ = Stage::settle;
    return false;
  }
  if (stage_ != Stage::settle || !settled) return false;
  set_friction(run, lane, own_friction_);
  set_local_damping(run, lane, own_damping_);
  const double e = void_ratio(run, lane);
  // Without friction it got no denser than this: its own densest state, whatever the cloud's is.
  if (friction_ == 0.0 && e > states_.densest_void_ratio) states_.densest_void_ratio = e;
  if (friction_ == 0.0 && relative_density_ == 1.0) return true;
  if (std::abs(states_.relative_density(e) - relative_density_) <= tolerance) return true;
  run.finish(lane, RunStatus::not_settled,
             fmt::format("prepared to relative density {:.2f} where {:.2f} was asked for (loosest "
                         "void ratio {:.4f}, densest {:.4f})",
                         states_.relative_density(e), relative_density_, states_.loosest_void_ratio,
                         states_.densest_void_ratio));
  return false;
}

double DensestStates::void_ratio_at(double ratio) const {
  std::size_t k = 1;
  while (k + 1 < void_ratio.size() && stress_over_modulus[k] < ratio) ++k;
  const double share = (ratio - stress_over_modulus[k - 1]) /
                       (stress_over_modulus[k] - stress_over_modulus[k - 1]);
  return void_ratio[k - 1] + share * (void_ratio[k] - void_ratio[k - 1]);
}

DensestStates measure_densest_states(const Packing& cloud, const Vec3& cloud_size_m,
                                     const RunOptions& options) {
  const SoilMaterial material{.contact_modulus_Pa = 2e6, .friction = 0.5};
  DensestStates densest;
  densest.stress_over_modulus = {2.5e-4, 1e-3, 4e-3, 16e-3};
  const std::size_t num_states = densest.stress_over_modulus.size();
  const std::vector<double> one_density(num_states, material.density_kg_per_m3);
  const std::vector<ExperimentResult> results =
      run_in_packs(one_density, options, [&](std::span<const std::size_t> state_of_lane) {
        const std::vector<SoilMaterial> lanes(state_of_lane.size(), material);
        LaneRun run(make_specimen(cloud, lanes, box_plates(cloud_size_m),
                                  {.max_gap_over_radius = -1}));
        std::vector<DensityPreparation> preparation;
        for (int lane = 0; lane < run.num_lanes(); ++lane) {
          const std::size_t state = state_of_lane[static_cast<std::size_t>(lane)];
          preparation.emplace_back(
              1.0, 0.0, densest.stress_over_modulus[state] * material.contact_modulus_Pa, material);
          preparation.back().start(run, lane);
        }
        run_protocol(run, IsotropicCompression::interval_steps, 2'000'000, options.stop,
                     [&preparation](LaneRun& r, int lane) {
                       const std::size_t k = static_cast<std::size_t>(lane);
                       if (!preparation[k].advance(r, lane)) return;
                       r.results[k].features = {{"void_ratio", void_ratio(r, lane)}};
                       r.finish(lane, RunStatus::completed, "settled");
                     });
        return run.results;
      });
  for (const ExperimentResult& r : results) {
    densest.status = r.status;
    densest.message = "the densest states could not be prepared: " + r.message;
    if (r.status != RunStatus::completed) return densest;
    densest.void_ratio.push_back(r.feature("void_ratio"));
  }
  return densest;
}

}  // namespace tilth
