// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/vane_shear.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/curve_features.hpp"
#include "experiments/servo.hpp"
#include "experiments/tool_shapes.hpp"

namespace tilth {
namespace {

enum WallId : int { bottom, top };
enum ToolId : int { vane };
enum Column : std::size_t { rotation, torque, shear_stress, surcharge, broken };

/// The box from the origin: floor and plate first.
std::vector<Wall> box_walls(const VaneShearConfig& c) {
  const double width = c.box_width_m;
  return {{.direction = Vec3::UnitZ()},
          {.direction = -Vec3::UnitZ(), .position_m = c.box_height_m * Vec3::UnitZ()},
          {.direction = Vec3::UnitX()},
          {.direction = -Vec3::UnitX(), .position_m = width * Vec3::UnitX()},
          {.direction = Vec3::UnitY()},
          {.direction = -Vec3::UnitY(), .position_m = width * Vec3::UnitY()}};
}

/// The vane in the middle of the box. A grain may sink to the middle of a blade before it is let go.
Tool vane_tool(const VaneShearConfig& c) {
  return {.mesh = vane_mesh(c.vane_diameter_m, c.vane_height_m, c.blade_thickness_m),
          .position_m = Vec3(0.5 * c.box_width_m, 0.5 * c.box_width_m,
                             0.5 * (c.box_height_m - c.vane_height_m)),
          .max_depth_m = 0.49 * c.blade_thickness_m};
}

struct LaneProgress {
  StressWatch surcharge;
  bool turning = false;
  double start_time_s = 0.0;
};

class VaneProtocol {
 public:
  VaneProtocol(const VaneShearConfig& config, std::span<const SoilMaterial> lanes)
      : config_(config), lanes_(lanes.begin(), lanes.end()), progress_(lanes.size()) {}

  static constexpr int interval_steps = 100;

  double tip_speed_m_per_s(std::size_t lane) const {
    return config_.tip_speed_over_wave_speed * wave_speed_m_per_s(lanes_[lane]);
  }

  void start(LaneRun& run) const {
    for (std::size_t k = 0; k < lanes_.size(); ++k) {
      set_nominal_rate(run.specimen.model, static_cast<int>(k),
                       tip_speed_m_per_s(k) / config_.vane_diameter_m);
      hold_stress(run, top, static_cast<int>(k), config_.surcharge_stress_Pa, area_m2(),
                  2e-3 * wave_speed_m_per_s(lanes_[k]));
    }
  }

  void operator()(LaneRun& run, int lane) {
    LaneProgress& p = progress_[static_cast<std::size_t>(lane)];
    if (p.turning) turn(run, lane, p);
    else consolidate(run, lane, p);
  }

 private:
  double area_m2() const { return config_.box_width_m * config_.box_width_m; }
  double angular_speed_rad_per_s(std::size_t lane) const {
    return tip_speed_m_per_s(lane) / (0.5 * config_.vane_diameter_m);
  }
  double plate_stress_Pa(const LaneRun& run, int lane) const {
    return run.wall_force_N(top, lane).z() / area_m2();
  }

  void consolidate(LaneRun& run, int lane, LaneProgress& p) {
    const double stress_Pa = plate_stress_Pa(run, lane);
    if (!p.surcharge.stands(run, lane, stress_Pa, config_.surcharge_stress_Pa)) return;
    p.turning = true;
    p.start_time_s = run.time_s(lane);
    run.specimen.state.tool_drive(vane, lane).angular_velocity_rad_per_s =
        angular_speed_rad_per_s(static_cast<std::size_t>(lane)) * Vec3::UnitZ();
  }

  void turn(LaneRun& run, int lane, const LaneProgress& p) {
    const std::size_t k = static_cast<std::size_t>(lane);
    const double middle_s = run.time_s(lane) - 0.5 * interval_steps * run.dt_s(lane);
    const double rotation_rad = (middle_s - p.start_time_s) * angular_speed_rad_per_s(k);
    const double torque_N_m = -run.tool_torque_N_m(vane, lane).z();
    run.results[k].curves.front().rows.push_back(
        {rotation_rad, torque_N_m,
         torque_N_m / vane_constant_m3(config_.vane_diameter_m, config_.vane_height_m),
         plate_stress_Pa(run, lane), run.workspace.num_broken[k]});
    if (rotation_rad >= config_.max_rotation_rad)
      run.finish(lane, RunStatus::completed, "at the rotation limit");
  }

  const VaneShearConfig& config_;
  std::vector<SoilMaterial> lanes_;
  std::vector<LaneProgress> progress_;
};

void read_features(ExperimentResult& r) {
  const Curve& curve = r.curves.front();
  const std::size_t peak = row_of_largest(curve, shear_stress);
  const std::size_t n = curve.rows.size();
  r.features = {{"vane_strength_Pa", curve.rows[peak][shear_stress]},
                {"residual_vane_strength_Pa",
                 mean_of(curve, shear_stress, n - std::max<std::size_t>(n / 4, 1), n)},
                {"rotation_at_peak_rad", curve.rows[peak][rotation]}};
}

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       const VaneShearConfig& config, const Packing& packing,
                                       const RunOptions& options) {
  LaneRun run(make_specimen(packing, lanes, box_walls(config), {config.bond_gap_over_radius},
                            {vane_tool(config)}));
  for (ExperimentResult& r : run.results)
    r.curves = {{"torque",
                 {"rotation_rad", "torque_N_m", "vane_shear_stress_Pa", "surcharge_Pa",
                  "bonds_broken"},
                 {}}};
  VaneProtocol protocol(config, lanes);
  protocol.start(run);
  run_protocol(run, VaneProtocol::interval_steps, 4'000'000, options, std::ref(protocol));
  for (std::size_t k = 0; k < run.results.size(); ++k) {
    ExperimentResult& r = run.results[k];
    if (r.status != RunStatus::completed) continue;
    read_features(r);
    r.inertial_number = protocol.tip_speed_m_per_s(k) / config.vane_diameter_m * 2 *
                        packing.mean_radius_m *
                        std::sqrt(lanes[k].density_kg_per_m3 /
                                  std::max(r.feature("vane_strength_Pa"), 1e-9));
  }
  return run.results;
}

}  // namespace

std::vector<Field> fields(VaneShearConfig& c) {
  return {{"box_width_m", &c.box_width_m, 1e-3, 10},
          {"box_height_m", &c.box_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, -1, 1},
          {"vane_diameter_m", &c.vane_diameter_m, 1e-3, 1},
          {"vane_height_m", &c.vane_height_m, 1e-3, 1},
          {"blade_thickness_m", &c.blade_thickness_m, 1e-5, 0.1},
          {"surcharge_stress_Pa", &c.surcharge_stress_Pa, 1, 1e8},
          {"tip_speed_over_wave_speed", &c.tip_speed_over_wave_speed, 1e-6, 1e-2},
          {"max_rotation_rad", &c.max_rotation_rad, 0.01, 6.3},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

PackingSpec packing_spec(const VaneShearConfig& c) {
  return {.shape = ContainerShape::box,
          .size_m = Vec3(c.box_width_m, c.box_width_m, c.box_height_m),
          .num_particles = c.num_particles,
          .porosity = c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

double vane_constant_m3(double diameter_m, double height_m) {
  return std::numbers::pi * diameter_m * diameter_m * (0.5 * height_m + diameter_m / 6);
}

std::vector<ExperimentResult> run_vane_shear(std::span<const SoilMaterial> members,
                                             const VaneShearConfig& config, PackingStore& packings,
                                             const RunOptions& options) {
  const PackingSpec spec = packing_spec(config);
  const Packing packing = packing_around(spec, *packings.get(spec), {vane_tool(config)});
  return run_members(members, options, [&](std::span<const SoilMaterial> lanes) {
    return run_pack(lanes, config, packing, options);
  });
}

}  // namespace tilth
