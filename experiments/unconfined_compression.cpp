// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/unconfined_compression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/curve_features.hpp"
#include "experiments/lane_run.hpp"

namespace tilth {
namespace {

enum PlatenId : int { bottom, top };

std::vector<Wall> platens(const UnconfinedCompressionConfig& config) {
  return {{.direction = Vec3::UnitZ()},
          {.direction = -Vec3::UnitZ(), .position_m = config.specimen_height_m * Vec3::UnitZ()}};
}

/// Platens and grains start with the velocity field of uniform axial straining, so that no shock
/// runs through the specimen.
void start_closing(LaneRun& run, const UnconfinedCompressionConfig& config,
                   std::span<const double> speed_m_per_s) {
  State& state = run.specimen.state;
  const std::size_t lanes = speed_m_per_s.size();
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const double v = speed_m_per_s[lane];
    state.drive(bottom, static_cast<int>(lane)).velocity_m_per_s = 0.5 * v * Vec3::UnitZ();
    state.drive(top, static_cast<int>(lane)).velocity_m_per_s = -0.5 * v * Vec3::UnitZ();
    for (std::size_t i = 0; i < run.specimen.model.radius_m.size(); ++i) {
      const double z = state.position_m(static_cast<int>(i), static_cast<int>(lane)).z();
      state.motion[(i * 9 + 5) * lanes + lane] = v * (0.5 - z / config.specimen_height_m);
    }
  }
}

void read_features(ExperimentResult& result, double num_bonds) {
  const Curve& curve = result.curves.front();
  const std::size_t peak = row_of_largest(curve, 1);
  result.features = {
      {"peak_stress_Pa", curve.rows[peak][1]},
      {"strain_at_peak", curve.rows[peak][0]},
      {"secant_modulus_Pa", secant_at_share(curve, 0, 1, peak, 0.5)},
      {"bonds_broken_at_peak", num_bonds > 0 ? curve.rows[peak][2] / num_bonds : 0.0}};
}

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       const UnconfinedCompressionConfig& config,
                                       const Packing& packing, const RunOptions& options) {
  // 1. bond the packing between the platens
  LaneRun run(make_specimen(packing, lanes, platens(config), {config.bond_gap_over_radius}));
  std::vector<double> speed_m_per_s;
  for (const SoilMaterial& m : lanes)
    speed_m_per_s.push_back(config.platen_speed_over_wave_speed * wave_speed_m_per_s(m));
  for (ExperimentResult& r : run.results)
    r.curves = {{"stress_strain", {"axial_strain", "axial_stress_Pa", "bonds_broken"}, {}}};

  // 2. close the platens until the stress has fallen or the strain is reached
  start_closing(run, config, speed_m_per_s);
  const double area_m2 = std::numbers::pi * config.specimen_radius_m * config.specimen_radius_m;
  constexpr int interval_steps = 20;
  const auto protocol = [&](LaneRun& r, int lane) {
    const std::size_t k = static_cast<std::size_t>(lane);
    Curve& curve = r.results[k].curves.front();
    const double middle_s = r.time_s(lane) - 0.5 * interval_steps * r.dt_s(lane);
    const double strain = middle_s * speed_m_per_s[k] / config.specimen_height_m;
    const double stress_Pa =
        0.5 * (r.wall_force_N(top, lane).z() - r.wall_force_N(bottom, lane).z()) / area_m2;
    curve.rows.push_back({strain, stress_Pa, r.workspace.num_broken[k]});
    const std::size_t peak = row_of_largest(curve, 1);
    const bool fallen = curve.rows[peak][1] > 0 && strain > 1.15 * curve.rows[peak][0] &&
                        stress_Pa < config.stop_at_peak_share * curve.rows[peak][1];
    if (fallen || strain >= config.max_axial_strain)
      r.finish(lane, RunStatus::completed, fallen ? "past the peak" : "at the strain limit");
  };
  run_protocol(run, interval_steps, 2'000'000, options.stop, protocol);

  // 3. read the curve
  for (std::size_t k = 0; k < run.results.size(); ++k) {
    ExperimentResult& r = run.results[k];
    if (r.status != RunStatus::completed) continue;
    read_features(r, static_cast<double>(run.specimen.model.bonds.size()));
    const double strain_rate_per_s = speed_m_per_s[k] / config.specimen_height_m;
    r.inertial_number = strain_rate_per_s * 2 * packing.mean_radius_m *
                        std::sqrt(lanes[k].density_kg_per_m3 /
                                  std::max(r.feature("peak_stress_Pa"), 1e-9));
  }
  return run.results;
}

}  // namespace

std::vector<Field> fields(UnconfinedCompressionConfig& c) {
  return {{"specimen_radius_m", &c.specimen_radius_m, 1e-3, 10},
          {"specimen_height_m", &c.specimen_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, 0, 1},
          {"platen_speed_over_wave_speed", &c.platen_speed_over_wave_speed, 1e-6, 1e-2},
          {"max_axial_strain", &c.max_axial_strain, 1e-3, 0.5},
          {"stop_at_peak_share", &c.stop_at_peak_share, 0, 0.99},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

PackingSpec packing_spec(const UnconfinedCompressionConfig& c) {
  return {.shape = ContainerShape::cylinder,
          .radius_m = c.specimen_radius_m,
          .size_m = Vec3(2 * c.specimen_radius_m, 2 * c.specimen_radius_m, c.specimen_height_m),
          .num_particles = c.num_particles,
          .porosity = c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

std::vector<ExperimentResult> run_unconfined_compression(std::span<const SoilMaterial> members,
                                                         const UnconfinedCompressionConfig& config,
                                                         PackingStore& packings,
                                                         const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  return run_in_packs(densities_kg_per_m3(members), options,
                      [&](std::span<const std::size_t> task_of_lane) {
                        return run_pack(pick(members, task_of_lane), config, *packing, options);
                      });
}

}  // namespace tilth
