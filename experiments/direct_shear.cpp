// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/direct_shear.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/curve_features.hpp"
#include "experiments/cut_block.hpp"
#include "experiments/servo.hpp"

namespace tilth {
namespace {

enum WallId : int {
  bottom,
  top,
  side_front,
  side_back,
  lower_left,
  lower_right,
  lower_ledge,
  upper_left,
  upper_right,
  upper_ledge
};
enum Column : std::size_t { displacement, shear_stress };  // of those read back

PackingSpec packing_spec(const DirectShearConfig& c) {
  return {.shape = ContainerShape::box,
          .size_m = Vec3(c.box_length_m, c.box_length_m, c.box_height_m),
          .num_particles = c.num_particles,
          .porosity = c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

/// A side wall facing +x or -x that reaches from the split plane far up (side = 1) or down (-1).
Wall half_wall(double x_m, double facing, double split_m, double side, double reach_m) {
  return {.direction = facing * Vec3::UnitX(),
          .position_m = Vec3(x_m, 0, split_m + side * reach_m),
          .tangent_a = Vec3::UnitY(),
          .tangent_b = Vec3::UnitZ(),
          .half_b_m = reach_m};
}

/// The rim of a half box beside the opening, in the split plane; it keeps grains from slipping past
/// the other half. The side wall owns the common edge.
Wall ledge(double x_m, double outward, double split_m, double facing, double reach_m) {
  return {.direction = facing * Vec3::UnitZ(),
          .position_m = Vec3(x_m + outward * reach_m, 0, split_m),
          .tangent_a = Vec3::UnitX(),
          .tangent_b = Vec3::UnitY(),
          .half_a_m = reach_m,
          .has_edges = false};
}

std::vector<Wall> box_walls(const DirectShearConfig& c) {
  const double length = c.box_length_m;
  const double split = 0.5 * c.box_height_m;
  const double reach = 10 * c.box_height_m;
  return {{.direction = Vec3::UnitZ()},
          {.direction = -Vec3::UnitZ(), .position_m = c.box_height_m * Vec3::UnitZ()},
          {.direction = Vec3::UnitY()},
          {.direction = -Vec3::UnitY(), .position_m = length * Vec3::UnitY()},
          half_wall(0, 1, split, -1, reach),
          half_wall(length, -1, split, -1, reach),
          ledge(length, 1, split, 1, reach),
          half_wall(0, 1, split, 1, reach),
          half_wall(length, -1, split, 1, reach),
          ledge(0, -1, split, -1, reach)};
}

struct LaneProgress {
  StressWatch consolidation;
  bool shearing = false;
  double start_time_s = 0.0;
  double start_height_m = 0.0;
};

class ShearProtocol {
 public:
  ShearProtocol(const DirectShearConfig& config, std::span<const SoilMaterial> lanes,
                std::span<const double> normal_stress_Pa)
      : config_(config),
        lanes_(lanes),
        target_Pa_(normal_stress_Pa),
        progress_(lanes.size()) {}

  double speed_m_per_s(std::size_t lane) const {
    return config_.shear_speed_over_wave_speed * wave_speed_m_per_s(lanes_[lane]);
  }
  double area_m2() const { return config_.box_length_m * config_.box_length_m; }

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
    if (p.shearing) shear(run, lane, p);
    else if (p.consolidation.stands(run, lane, normal_stress_Pa(run, lane), target_Pa_[k]))
      begin_shear(run, lane, p);
  }

  /// Long enough that the peak is not the largest of many noisy readings.
  static constexpr int interval_steps = 100;

 private:
  double normal_stress_Pa(const LaneRun& run, int lane) const {
    return 0.5 * (run.wall_force_N(top, lane).z() - run.wall_force_N(bottom, lane).z()) / area_m2();
  }

  void begin_shear(LaneRun& run, int lane, LaneProgress& p) {
    p.shearing = true;
    p.start_time_s = run.time_s(lane);
    p.start_height_m = run.specimen.state.wall_position_m(top, lane).z();
    const Vec3 velocity = speed_m_per_s(static_cast<std::size_t>(lane)) * Vec3::UnitX();
    for (const int wall : {upper_left, upper_right, upper_ledge})
      run.specimen.state.drive(wall, lane).velocity_m_per_s = velocity;
  }

  void shear(LaneRun& run, int lane, const LaneProgress& p) {
    const std::size_t k = static_cast<std::size_t>(lane);
    const auto force_x = [&](int a, int b) {
      return run.wall_force_N(a, lane).x() + run.wall_force_N(b, lane).x();
    };
    const double middle_s = run.time_s(lane) - 0.5 * interval_steps * run.dt_s(lane);
    const double moved_m = (middle_s - p.start_time_s) * speed_m_per_s(k);
    // The specimen pushes the advancing upper half back: its force is negative.
    const double stress_Pa =
        0.5 * (force_x(lower_left, lower_right) - force_x(upper_left, upper_right)) / area_m2();
    const double rise_m =
        run.specimen.state.wall_position_m(top, lane).z() - p.start_height_m;
    run.results[k].curves.front().rows.push_back({moved_m, stress_Pa, normal_stress_Pa(run, lane),
                                                  rise_m, run.workspace.num_broken[k]});
    if (moved_m >= config_.max_shear_strain * config_.box_length_m)
      run.finish(lane, RunStatus::completed, "at the displacement limit");
  }

  const DirectShearConfig& config_;
  std::span<const SoilMaterial> lanes_;
  std::span<const double> target_Pa_;
  std::vector<LaneProgress> progress_;
};

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       std::span<const double> normal_stress_Pa,
                                       const DirectShearConfig& config, const Packing& packing,
                                       const RunOptions& options) {
  BondingSpec bonding{config.bond_gap_over_radius};
  bonding.place.bedding = Vec3(std::sin(config.cut_angle_rad), 0, std::cos(config.cut_angle_rad));
  LaneRun run(make_specimen(packing, lanes, box_walls(config), bonding));
  for (std::size_t k = 0; k < lanes.size(); ++k)
    run.results[k].curves = {{fmt::format("shear_{:.0f}Pa", normal_stress_Pa[k]),
                              {"shear_displacement_m", "shear_stress_Pa", "normal_stress_Pa",
                               "vertical_displacement_m", "bonds_broken"},
                              {}}};
  ShearProtocol protocol(config, lanes, normal_stress_Pa);
  protocol.start(run);
  run_protocol(run, ShearProtocol::interval_steps, 4'000'000, options, std::ref(protocol));
  for (std::size_t k = 0; k < lanes.size(); ++k)
    run.results[k].inertial_number =
        protocol.speed_m_per_s(k) / config.box_height_m * 2 * packing.mean_radius_m *
        std::sqrt(lanes[k].density_kg_per_m3 / normal_stress_Pa[k]);
  return run.results;
}

void add_line_features(const std::vector<double>& normal_Pa, const std::vector<double>& shear_Pa,
                       const std::string& prefix, std::vector<Feature>& features) {
  if (normal_Pa.size() < 2) return;
  const Line line = fit_line(normal_Pa, shear_Pa);
  features.push_back({prefix + "cohesion_Pa", line.intercept});
  features.push_back({prefix + "friction_angle_rad", std::atan(line.slope)});
}

/// Joins the shear tests of one member; the first failure is the member's.
ExperimentResult join(const DirectShearConfig& config, std::span<ExperimentResult> tests) {
  ExperimentResult member = joined_status(
      tests,
      [&config](std::size_t k) {
        return fmt::format("at normal stress {:.4g} Pa: ", config.normal_stress_Pa[k]);
      },
      "sheared at every normal stress");
  std::vector<double> peaks_Pa, residuals_Pa;
  for (std::size_t k = 0; k < tests.size(); ++k) {
    if (tests[k].status != RunStatus::completed) continue;
    const double p = config.normal_stress_Pa[k];
    Curve& curve = tests[k].curves.front();
    const std::size_t peak = row_of_largest(curve, shear_stress);
    peaks_Pa.push_back(curve.rows[peak][shear_stress]);
    residuals_Pa.push_back(mean_of_last_quarter(curve, shear_stress));
    const auto at = [p](const char* name) { return fmt::format("{}@{:.0f}", name, p); };
    member.features.push_back({at("peak_shear_stress_Pa"), peaks_Pa.back()});
    member.features.push_back({at("residual_shear_stress_Pa"), residuals_Pa.back()});
    member.features.push_back({at("displacement_at_peak_m"), curve.rows[peak][displacement]});
    member.curves.push_back(std::move(curve));
  }
  if (member.status != RunStatus::completed) {
    member.features.clear();
    return member;
  }
  add_line_features(config.normal_stress_Pa, peaks_Pa, "", member.features);
  add_line_features(config.normal_stress_Pa, residuals_Pa, "residual_", member.features);
  return member;
}

}  // namespace

std::vector<Field> fields(DirectShearConfig& c) {
  return {{"box_length_m", &c.box_length_m, 1e-3, 10},
          {"box_height_m", &c.box_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, -1, 1},
          {"normal_stress_Pa", &c.normal_stress_Pa, 1, 1e8},
          {"shear_speed_over_wave_speed", &c.shear_speed_over_wave_speed, 1e-6, 1e-2},
          {"max_shear_strain", &c.max_shear_strain, 1e-3, 0.5},
          {"cut_angle_rad", &c.cut_angle_rad, -3.2, 3.2},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

std::vector<ExperimentResult> run_direct_shear(std::span<const SoilMaterial> members,
                                               const DirectShearConfig& config,
                                               PackingStore& packings, const RunOptions& options) {
  const auto packing = cut_block(packings, packing_spec(config), config.cut_angle_rad);
  return run_settings(
      members, config.normal_stress_Pa, options,
      [&](std::span<const SoilMaterial> lanes, std::span<const double> normal_stress_Pa) {
        return run_pack(lanes, normal_stress_Pa, config, *packing, options);
      },
      [&config](std::span<ExperimentResult> tests) { return join(config, tests); });
}

}  // namespace tilth
