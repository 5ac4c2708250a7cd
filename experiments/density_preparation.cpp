// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/density_preparation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tilth {
namespace {

constexpr double friction_decay = 0.2;     ///< of ln(friction) per inertial time
/// Stronger damping lets the friction run ahead of the grains: targets of 0.80 came out as 0.87.
constexpr double preparation_damping = 0.2;
constexpr double frictionless = 2e-3;      ///< below it friction is taken away altogether
constexpr double tolerance = 0.25;         ///< of relative density, above which a lane fails

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
  const LaneLaw& law = run.specimen.model.lanes[static_cast<std::size_t>(lane)];
  own_rolling_friction_ = law.rolling_friction;
  own_effects_ = law.effects;
  set_effects(run, lane, 0.0, {});
  set_local_damping(run, lane, preparation_damping);
  press_.start(run, lane);
}

/// Lowers the friction; true when the void ratio is reached, or at rest without friction.
bool DensityPreparation::densify(LaneRun& run, int lane, bool settled) {
  if (void_ratio(run, lane) <= states_.void_ratio(relative_density_)) return true;
  if (friction_ == 0.0) return settled;
  friction_ *= std::exp(-friction_decay * IsotropicCompression::interval_steps * run.dt_s(lane) /
                        press_.inertial_time_s(run));
  if (friction_ < frictionless) {
    friction_ = 0.0;
    press_.settle_again();
  }
  set_friction(run, lane, friction_);
  return false;
}

bool DensityPreparation::advance(LaneRun& run, int lane) {
  const bool settled = press_.advance(run, lane);
  if (!run.active(lane)) return false;
  if (stage_ == Stage::press && settled) {
    states_.loosest_void_ratio = void_ratio(run, lane);
    stage_ = Stage::densify;
    press_.settle_again();
    return false;
  }
  if (stage_ == Stage::densify && densify(run, lane, settled)) {
    set_friction(run, lane, own_friction_);
    set_effects(run, lane, own_rolling_friction_, own_effects_);
    press_.settle_again();
    stage_ = Stage::settle;
    return false;
  }
  if (stage_ != Stage::settle || !settled) return false;
  set_local_damping(run, lane, own_damping_);
  const double reached = states_.relative_density(void_ratio(run, lane));
  if (std::abs(reached - relative_density_) <= tolerance) return true;
  // At rest without friction it is in its own densest state, whatever the cloud's mean is.
  const bool is_own_densest = friction_ == 0.0;
  if (is_own_densest && relative_density_ >= 1 - tolerance) return true;
  run.finish(lane, RunStatus::not_settled,
             fmt::format("prepared to relative density {:.2f} where {:.2f} was asked for (loosest "
                         "void ratio {:.4f}, densest {:.4f})",
                         reached, relative_density_, states_.loosest_void_ratio,
                         states_.densest_void_ratio));
  return false;
}

namespace {

constexpr double measured_at[] = {2.5e-4, 5e-4, 1e-3, 2e-3, 4e-3, 8e-3, 16e-3, 24e-3};  ///< stress over modulus

}  // namespace

double DensestStates::void_ratio_at(double ratio) const {
  const double x = std::clamp(ratio, std::begin(measured_at)[0], std::end(measured_at)[-1]);
  return coefficients[0] + x * (coefficients[1] + x * coefficients[2]);
}

namespace {

std::vector<double> parabola_through(const std::vector<double>& void_ratio) {
  Eigen::MatrixX3d powers(void_ratio.size(), 3);
  for (Eigen::Index k = 0; k < powers.rows(); ++k) {
    const double x = measured_at[k];
    powers.row(k) << 1, x, x * x;
  }
  const Eigen::Vector3d c = powers.colPivHouseholderQr().solve(
      Eigen::Map<const Eigen::VectorXd>(void_ratio.data(), powers.rows()));
  return {c.begin(), c.end()};
}

std::vector<ExperimentResult> run_densest(std::span<const std::size_t> state_of_lane,
                                          const Packing& cloud, const Vec3& size_m,
                                          const RunOptions& options) {
  const SoilMaterial material{.contact_modulus_Pa = 2e6, .friction = 0.5};
  const std::vector<SoilMaterial> lanes(state_of_lane.size(), material);
  LaneRun run(make_specimen(cloud, lanes, box_plates(size_m), {.max_gap_over_radius = -1}));
  std::vector<DensityPreparation> preparation;
  for (int lane = 0; lane < run.num_lanes(); ++lane) {
    const double ratio = measured_at[state_of_lane[static_cast<std::size_t>(lane)]];
    preparation.emplace_back(1.0, 0.0, ratio * material.contact_modulus_Pa, material);
    preparation.back().start(run, lane);
  }
  run_protocol(run, IsotropicCompression::interval_steps, 2'000'000, options,
               [&preparation](LaneRun& r, int lane) {
                 const std::size_t k = static_cast<std::size_t>(lane);
                 if (!preparation[k].advance(r, lane)) return;
                 r.results[k].features = {{"void_ratio", void_ratio(r, lane)}};
                 r.finish(lane, RunStatus::completed, "settled");
               });
  return run.results;
}

}  // namespace

DensestStates densest_states(PackingStore& packings, const PackingSpec& cloud,
                             const RunOptions& options) {
  DensestStates densest;
  densest.status = RunStatus::completed;
  densest.coefficients = packings.numbers("densest states, parabola: " + packing_key(cloud), [&] {
    const auto packing = packings.get(cloud);
    const std::vector<double> one_density(std::size(measured_at), 1.0);
    const std::vector<ExperimentResult> results =
        run_in_packs(one_density, options, [&](std::span<const std::size_t> state_of_lane) {
          return run_densest(state_of_lane, *packing, cloud.size_m, options);
        });
    std::vector<double> void_ratio;
    for (const ExperimentResult& r : results) {
      if (r.status != RunStatus::completed) {
        densest.status = r.status;
        densest.message = "the densest states could not be prepared: " + r.message;
        return PackingStore::Numbers();
      }
      void_ratio.push_back(r.feature("void_ratio"));
    }
    return parabola_through(void_ratio);
  });
  return densest;
}

}  // namespace tilth
