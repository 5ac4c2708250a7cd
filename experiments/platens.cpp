// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/platens.hpp"

#include <cmath>
#include <numbers>

#include "experiments/curve_features.hpp"

namespace tilth {

std::vector<Wall> platens(double height_m) {
  return {{.direction = Vec3::UnitZ()},
          {.direction = -Vec3::UnitZ(), .position_m = height_m * Vec3::UnitZ()}};
}

void start_straining(LaneRun& run, double height_m, std::span<const double> closing_speed_m_per_s) {
  State& state = run.specimen.state;
  const std::size_t lanes = closing_speed_m_per_s.size();
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const int l = static_cast<int>(lane);
    const double v = closing_speed_m_per_s[lane];
    state.drive(bottom_platen, l).velocity_m_per_s = 0.5 * v * Vec3::UnitZ();
    state.drive(top_platen, l).velocity_m_per_s = -0.5 * v * Vec3::UnitZ();
    for (std::size_t i = 0; i < run.specimen.model.radius_m.size(); ++i) {
      const double z = state.position_m(static_cast<int>(i), l).z();
      state.motion[(i * 9 + 5) * lanes + lane] = v * (0.5 - z / height_m);
    }
  }
}

double axial_force_N(const LaneRun& run, int lane) {
  return 0.5 *
         (run.wall_force_N(top_platen, lane).z() - run.wall_force_N(bottom_platen, lane).z());
}

void run_past_peak(LaneRun& run, const AxialLoading& loading, const RunOptions& options) {
  std::vector<double> closing_speed_m_per_s;
  for (const double v : loading.speed_m_per_s) closing_speed_m_per_s.push_back(loading.sense * v);
  start_straining(run, loading.height_m, closing_speed_m_per_s);
  const double area_m2 = std::numbers::pi * loading.radius_m * loading.radius_m;
  constexpr int interval_steps = 20;
  const auto protocol = [&](LaneRun& r, int lane) {
    const std::size_t k = static_cast<std::size_t>(lane);
    Curve& curve = r.results[k].curves.front();
    const double middle_s = r.time_s(lane) - 0.5 * interval_steps * r.dt_s(lane);
    const double strain = middle_s * loading.speed_m_per_s[k] / loading.height_m;
    const double stress_Pa = loading.sense * axial_force_N(r, lane) / area_m2;
    curve.rows.push_back({strain, stress_Pa, r.workspace.num_broken[k]});
    const std::size_t peak = row_of_largest(curve, 1);
    const bool fallen = curve.rows[peak][1] > 0 && strain > 1.15 * curve.rows[peak][0] &&
                        stress_Pa < loading.stop_at_peak_share * curve.rows[peak][1];
    if (fallen || strain >= loading.max_axial_strain)
      r.finish(lane, RunStatus::completed, fallen ? "past the peak" : "at the strain limit");
  };
  run_protocol(run, interval_steps, 2'000'000, options, protocol);
}

PackingSpec cylinder_packing(double radius_m, double height_m, int num_particles, double porosity,
                             double size_spread, std::uint64_t seed) {
  return {.shape = ContainerShape::cylinder,
          .radius_m = radius_m,
          .size_m = Vec3(2 * radius_m, 2 * radius_m, height_m),
          .num_particles = num_particles,
          .porosity = porosity,
          .size_spread = size_spread,
          .seed = seed};
}

double axial_inertial_number(double speed_m_per_s, double height_m, double mean_radius_m,
                             double density_kg_per_m3, double stress_Pa) {
  return speed_m_per_s / height_m * 2 * mean_radius_m * std::sqrt(density_kg_per_m3 / stress_Pa);
}

}  // namespace tilth
