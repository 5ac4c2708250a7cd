// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/cone_penetration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/curve_features.hpp"
#include "experiments/settled_bed.hpp"
#include "experiments/tool_shapes.hpp"

namespace tilth {
namespace {

enum ToolId : int { cone };
enum Column : std::size_t { depth, force, resistance, broken };
enum CurveId : std::size_t { penetration, withdrawal };
enum class Stage { settle, push, draw };

constexpr double standard_speed_m_per_s = 0.03;

double cone_height_m(const ConePenetrationConfig& c) {
  return 0.5 * c.base_diameter_m / std::tan(0.5 * c.apex_angle_rad);
}

double base_area_m2(const ConePenetrationConfig& c) {
  return 0.25 * std::numbers::pi * c.base_diameter_m * c.base_diameter_m;
}

/// Floor and cylinder; the bed is open above.
std::vector<Wall> chamber(const ConePenetrationConfig& c) {
  return {{.direction = Vec3::UnitZ()},
          {.shape = WallShape::cylinder, .radius_m = c.chamber_radius_m}};
}

/// The cone, held clear of the bed; its shaft never goes under.
Tool cone_tool(const ConePenetrationConfig& c) {
  const double length_m = cone_height_m(c) + c.depth_m + c.bed_height_m;
  return {.mesh = cone_mesh(c.apex_angle_rad, c.base_diameter_m,
                            std::min(c.shaft_diameter_m, c.base_diameter_m), length_m, c.num_sides),
          .position_m = 1.5 * c.bed_height_m * Vec3::UnitZ()};
}

struct LaneProgress {
  Stage stage = Stage::settle;
  CalmWatch watch{1e-5, 5};
  double surface_m = 0.0;  ///< mean settled level
};

class ConeProtocol {
 public:
  ConeProtocol(const ConePenetrationConfig& config, const LaneRun& run)
      : config_(config), progress_(run.results.size()) {
    const Model& model = run.specimen.model;
    for (int i = 0; i < model.num_particles(); ++i) {
      const double z = run.specimen.state.position_m(i).z();
      if (z > config.bed_height_m - 4 * run.specimen.mean_radius_m) top_layer_.push_back({i, z});
    }
  }

  static constexpr int interval_steps = 100;

  void operator()(LaneRun& run, int lane) {
    LaneProgress& p = progress_[static_cast<std::size_t>(lane)];
    if (p.stage == Stage::settle) settle(run, lane, p);
    else move(run, lane, p);
  }

  void read_features(ExperimentResult& r) const {
    const Curve& in = r.curves[penetration];
    std::vector<double> depth_m, resistance_Pa;
    double sum_Pa = 0.0;
    std::size_t num_deep = 0;
    for (const auto& row : in.rows) {
      if (row[depth] < 0) continue;
      depth_m.push_back(row[depth]);
      resistance_Pa.push_back(row[resistance]);
      if (row[depth] < 0.5 * config_.depth_m) continue;
      sum_Pa += row[resistance];
      ++num_deep;
    }
    r.features = {{"cone_resistance_Pa", sum_Pa / static_cast<double>(num_deep)},
                  {"cone_resistance_gradient_Pa_per_m", fit_line(depth_m, resistance_Pa).slope}};
    double largest_N = 0.0;
    for (const auto& row : r.curves[withdrawal].rows) largest_N = std::max(largest_N, -row[force]);
    if (config_.withdrawal_over_depth > 0) r.features.push_back({"pull_out_force_N", largest_N});
  }

 private:
  void settle(LaneRun& run, int lane, LaneProgress& p) {
    if (p.watch.calm(agitation(run, lane))) begin_push(run, lane, p);
    else if (run.specimen.state.num_steps > 200'000)
      run.finish(lane, RunStatus::not_settled,
                 fmt::format("the bed still moved after {} steps (agitation {:.3g})",
                             run.specimen.state.num_steps, agitation(run, lane)));
  }

  void begin_push(LaneRun& run, int lane, LaneProgress& p) {
    State& state = run.specimen.state;
    double sunk_m = 0.0;
    for (const auto& [i, z] : top_layer_) sunk_m += z - state.position_m(i, lane).z();
    p.surface_m = config_.bed_height_m - sunk_m / static_cast<double>(top_layer_.size());
    // One grain above the surface, so that no grain that stands out is hit at once.
    const Vec3 tip_m = (p.surface_m + 2 * run.specimen.mean_radius_m) * Vec3::UnitZ();
    state.set_tool_position_m(cone, lane, tip_m);
    model_changed(run.workspace);
    drive(run, lane, -1);
    p.stage = Stage::push;
  }

  void drive(LaneRun& run, int lane, double sense) const {
    run.specimen.state.tool_drive(cone, lane).velocity_m_per_s =
        sense * config_.speed_m_per_s * Vec3::UnitZ();
  }

  void move(LaneRun& run, int lane, LaneProgress& p) {
    const std::size_t k = static_cast<std::size_t>(lane);
    const double base_m = run.specimen.state.tool_position_m(cone, lane).z() + cone_height_m(config_);
    const bool pushing = p.stage == Stage::push;
    // The position is that at the interval's end, the force its mean, half an interval earlier.
    const double lag_m = 0.5 * interval_steps * run.dt_s(lane) * config_.speed_m_per_s;
    const double depth_m = p.surface_m - base_m + (pushing ? -lag_m : lag_m);
    const double force_N = run.tool_force_N(cone, lane).z();
    run.results[k].curves[pushing ? penetration : withdrawal].rows.push_back(
        {depth_m, force_N, force_N / base_area_m2(config_), run.workspace.num_broken[k]});
    if (pushing && depth_m >= config_.depth_m) {
      p.stage = Stage::draw;
      drive(run, lane, 1);
    }
    const double drawn_to_m = (1 - config_.withdrawal_over_depth) * config_.depth_m;
    if (p.stage == Stage::draw && depth_m <= std::max(drawn_to_m, 0.0))
      run.finish(lane, RunStatus::completed, "pushed in and drawn back");
    else if (p.stage == Stage::draw && config_.withdrawal_over_depth == 0)
      run.finish(lane, RunStatus::completed, "pushed in");
  }

  const ConePenetrationConfig& config_;
  std::vector<LaneProgress> progress_;
  std::vector<std::pair<int, double>> top_layer_;  ///< grain, height before it settles
};

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       const ConePenetrationConfig& config, const Packing& packing,
                                       const RunOptions& options) {
  // 1. bond the packing as it lies and turn gravity on
  LaneRun run(make_specimen(
      packing, lanes, chamber(config),
      {config.bond_gap_over_radius, {}, {.surface_m = config.bed_height_m}}, {cone_tool(config)}));
  // A cone of the standard's 30 mm/s strains soil much faster than the laboratory does, at any size.
  for (int lane = 0; lane < run.num_lanes(); ++lane)
    set_nominal_rate(run.specimen.model, lane,
                     laboratory_rate_per_s * config.speed_m_per_s / standard_speed_m_per_s);
  run.specimen.model.gravity_m_per_s2 = -config.gravity_m_per_s2 * Vec3::UnitZ();
  const std::vector<std::string> columns = {"depth_m", "cone_force_N", "cone_resistance_Pa",
                                            "bonds_broken"};
  for (ExperimentResult& r : run.results)
    r.curves = {{"penetration", columns, {}}, {"withdrawal", columns, {}}};

  // 2. settle, push the cone in, draw it back
  ConeProtocol protocol(config, run);
  run_protocol(run, ConeProtocol::interval_steps, 8'000'000, options, std::ref(protocol));

  // 3. read the curves
  for (std::size_t k = 0; k < run.results.size(); ++k) {
    ExperimentResult& r = run.results[k];
    if (r.status != RunStatus::completed) continue;
    protocol.read_features(r);
    r.inertial_number =
        config.speed_m_per_s / config.base_diameter_m * 2 * packing.mean_radius_m *
        std::sqrt(lanes[k].density_kg_per_m3 / std::max(r.feature("cone_resistance_Pa"), 1e-9));
  }
  return run.results;
}

}  // namespace

std::vector<Field> fields(ConePenetrationConfig& c) {
  return {{"chamber_radius_m", &c.chamber_radius_m, 1e-3, 10},
          {"bed_height_m", &c.bed_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, -1, 1},
          {"gravity_m_per_s2", &c.gravity_m_per_s2, 1e-3, 1000},
          {"apex_angle_rad", &c.apex_angle_rad, 0.1, 3.0},
          {"base_diameter_m", &c.base_diameter_m, 1e-3, 1},
          {"shaft_diameter_m", &c.shaft_diameter_m, 1e-4, 1},
          {"num_sides", &c.num_sides, 6, 64},
          {"depth_m", &c.depth_m, 1e-3, 10},
          {"withdrawal_over_depth", &c.withdrawal_over_depth, 0, 1},
          {"speed_m_per_s", &c.speed_m_per_s, 1e-5, 30},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

PackingSpec packing_spec(const ConePenetrationConfig& c) {
  return {.shape = ContainerShape::cylinder,
          .radius_m = c.chamber_radius_m,
          .size_m = Vec3(2 * c.chamber_radius_m, 2 * c.chamber_radius_m, c.bed_height_m),
          .num_particles = c.num_particles,
          .porosity = c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

std::vector<ExperimentResult> run_cone_penetration(std::span<const SoilMaterial> members,
                                                   const ConePenetrationConfig& config,
                                                   PackingStore& packings,
                                                   const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  return run_members(members, options, [&](std::span<const SoilMaterial> lanes) {
    return run_pack(lanes, config, *packing, options);
  });
}

}  // namespace tilth
