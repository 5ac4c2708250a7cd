// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/interface_shear.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/curve_features.hpp"
#include "experiments/servo.hpp"

namespace tilth {
namespace {

enum WallId : int { steel, top };
enum Column : std::size_t { displacement, interface_stress, normal_stress };  // of those read back

PackingSpec packing_spec(const InterfaceShearConfig& c) {
  return {.shape = ContainerShape::box,
          .size_m = Vec3(c.box_length_m, c.box_length_m, c.box_height_m),
          .num_particles = c.num_particles,
          .porosity = c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

std::vector<Wall> box_walls(const InterfaceShearConfig& c) {
  const double length = c.box_length_m;
  std::vector<Wall> walls = {
      {.direction = Vec3::UnitZ()},
      {.direction = -Vec3::UnitZ(), .position_m = c.box_height_m * Vec3::UnitZ()},
      {.direction = Vec3::UnitX()},
      {.direction = -Vec3::UnitX(), .position_m = length * Vec3::UnitX()},
      {.direction = Vec3::UnitY()},
      {.direction = -Vec3::UnitY(), .position_m = length * Vec3::UnitY()}};
  for (std::size_t w = top; w < walls.size(); ++w) walls[w].friction_scale = 0;
  walls[steel].adhesion_scale = 1;
  return walls;
}

struct LaneProgress {
  StressWatch consolidation;
  bool sliding = false;
  double start_time_s = 0.0;
  double start_height_m = 0.0;
};

class SlideProtocol {
 public:
  SlideProtocol(const InterfaceShearConfig& config, std::span<const SoilMaterial> lanes,
                std::span<const double> normal_stress_Pa)
      : config_(config),
        lanes_(lanes),
        target_Pa_(normal_stress_Pa),
        progress_(lanes.size()) {}

  double speed_m_per_s(std::size_t lane) const {
    return config_.slide_speed_over_wave_speed * wave_speed_m_per_s(lanes_[lane]);
  }

  void start(LaneRun& run) const {
    for (std::size_t k = 0; k < lanes_.size(); ++k) {
      set_nominal_rate(run.specimen.model, static_cast<int>(k),
                       speed_m_per_s(k) / config_.box_height_m);
      hold_stress(run, top, static_cast<int>(k), target_Pa_[k], area_m2(),
                  2e-3 * wave_speed_m_per_s(lanes_[k]));
    }
  }

  void operator()(LaneRun& run, int lane) {
    const std::size_t k = static_cast<std::size_t>(lane);
    LaneProgress& p = progress_[k];
    const double normal_Pa = -run.wall_force_N(steel, lane).z() / area_m2();
    if (p.sliding) record(run, lane, normal_Pa);
    else if (p.consolidation.stands(run, lane, normal_Pa, target_Pa_[k])) begin(run, lane);
  }

  /// As in direct shear: long enough that the peak is not the largest of many noisy readings.
  static constexpr int interval_steps = 100;

 private:
  double area_m2() const { return config_.box_length_m * config_.box_length_m; }

  void begin(LaneRun& run, int lane) {
    LaneProgress& p = progress_[static_cast<std::size_t>(lane)];
    p.sliding = true;
    p.start_time_s = run.time_s(lane);
    p.start_height_m = run.specimen.state.wall_position_m(top, lane).z();
    run.specimen.state.drive(steel, lane).velocity_m_per_s =
        speed_m_per_s(static_cast<std::size_t>(lane)) * Vec3::UnitX();
  }

  void record(LaneRun& run, int lane, double normal_Pa) {
    const std::size_t k = static_cast<std::size_t>(lane);
    const LaneProgress& p = progress_[k];
    const double middle_s = run.time_s(lane) - 0.5 * interval_steps * run.dt_s(lane);
    const double moved_m = (middle_s - p.start_time_s) * speed_m_per_s(k);
    const double rise_m = run.specimen.state.wall_position_m(top, lane).z() - p.start_height_m;
    // The soil holds the advancing steel back: its force is negative.
    run.results[k].curves.front().rows.push_back({moved_m,
                                                  -run.wall_force_N(steel, lane).x() / area_m2(),
                                                  normal_Pa, rise_m, run.workspace.num_broken[k]});
    if (moved_m >= config_.max_slide_over_length * config_.box_length_m)
      run.finish(lane, RunStatus::completed, "at the displacement limit");
  }

  const InterfaceShearConfig& config_;
  std::span<const SoilMaterial> lanes_;
  std::span<const double> target_Pa_;
  std::vector<LaneProgress> progress_;
};

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       std::span<const double> normal_stress_Pa,
                                       const InterfaceShearConfig& config, const Packing& packing,
                                       const RunOptions& options) {
  LaneRun run(make_specimen(packing, lanes, box_walls(config), {config.bond_gap_over_radius}));
  for (std::size_t k = 0; k < lanes.size(); ++k)
    run.results[k].curves = {{fmt::format("slide_{:.0f}Pa", normal_stress_Pa[k]),
                              {"slide_displacement_m", "interface_stress_Pa", "normal_stress_Pa",
                               "vertical_displacement_m", "bonds_broken"},
                              {}}};
  SlideProtocol protocol(config, lanes, normal_stress_Pa);
  protocol.start(run);
  run_protocol(run, SlideProtocol::interval_steps, 4'000'000, options, std::ref(protocol));
  for (std::size_t k = 0; k < lanes.size(); ++k)
    run.results[k].inertial_number =
        protocol.speed_m_per_s(k) / config.box_height_m * 2 * packing.mean_radius_m *
        std::sqrt(lanes[k].density_kg_per_m3 / normal_stress_Pa[k]);
  return run.results;
}

/// Joins the runs of one member; the first failure is the member's.
ExperimentResult join(const InterfaceShearConfig& config, std::span<ExperimentResult> runs) {
  ExperimentResult member = joined_status(
      runs,
      [&config](std::size_t k) {
        return fmt::format("at normal stress {:.4g} Pa: ", config.normal_stress_Pa[k]);
      },
      "slid at every normal stress");
  std::vector<double> normal_Pa, residual_Pa;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (runs[k].status != RunStatus::completed) continue;
    Curve& curve = runs[k].curves.front();
    const std::size_t peak = row_of_largest(curve, interface_stress);
    normal_Pa.push_back(mean_of_last_quarter(curve, normal_stress));
    residual_Pa.push_back(mean_of_last_quarter(curve, interface_stress));
    const auto at = [p = config.normal_stress_Pa[k]](const char* name) {
      return fmt::format("{}@{:.0f}", name, p);
    };
    member.features.push_back({at("peak_interface_stress_Pa"), curve.rows[peak][interface_stress]});
    member.features.push_back({at("residual_interface_stress_Pa"), residual_Pa.back()});
    member.features.push_back({at("slide_at_peak_m"), curve.rows[peak][displacement]});
    member.curves.push_back(std::move(curve));
  }
  if (member.status != RunStatus::completed) {
    member.features.clear();
  } else if (normal_Pa.size() >= 2) {
    const Line line = fit_line(normal_Pa, residual_Pa);
    member.features.push_back({"adhesion_Pa", line.intercept});
    member.features.push_back({"interface_friction_angle_rad", std::atan(line.slope)});
  }
  return member;
}

}  // namespace

std::vector<Field> fields(InterfaceShearConfig& c) {
  return {{"box_length_m", &c.box_length_m, 1e-3, 10},
          {"box_height_m", &c.box_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, -1, 1},
          {"normal_stress_Pa", &c.normal_stress_Pa, 1, 1e8},
          {"slide_speed_over_wave_speed", &c.slide_speed_over_wave_speed, 1e-6, 1e-2},
          {"max_slide_over_length", &c.max_slide_over_length, 1e-3, 1},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

std::vector<ExperimentResult> run_interface_shear(std::span<const SoilMaterial> members,
                                                  const InterfaceShearConfig& config,
                                                  PackingStore& packings,
                                                  const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  return run_settings(
      members, config.normal_stress_Pa, options,
      [&](std::span<const SoilMaterial> lanes, std::span<const double> normal_stress_Pa) {
        return run_pack(lanes, normal_stress_Pa, config, *packing, options);
      },
      [&config](std::span<ExperimentResult> runs) { return join(config, runs); });
}

}  // namespace tilth
