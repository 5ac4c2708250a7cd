// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/sweep_tillage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem_core/time_step.hpp"
#include "experiments/settled_bed.hpp"
#include "experiments/sweep_features.hpp"
#include "experiments/sweep_flow.hpp"
#include "experiments/sweep_stretch.hpp"
#include "experiments/tool_shapes.hpp"

namespace tilth {
namespace {

enum WallId : int { floor_wall };
enum ToolId : int { sweep_tool };
enum class Stage { settle, travel, rest };

constexpr double longest_rest_s = 3.0;

/// Open above; x = 0 is where the tool comes in.
std::vector<Wall> bin_walls(const SweepTillageConfig& c) {
  const Vec3 right_m = -0.5 * c.bin_width_m * Vec3::UnitY();
  return {{.direction = Vec3::UnitZ()},
          {.direction = Vec3::UnitX()},
          {.direction = -Vec3::UnitX(), .position_m = c.bin_length_m * Vec3::UnitX()},
          {.direction = Vec3::UnitY(), .position_m = right_m},
          {.direction = -Vec3::UnitY(), .position_m = -right_m}};
}

/// Outside the bed, its foremost point a radius before the front wall; the final height comes
/// later.
Tool waiting_tool(const SweepTillageConfig& c) {
  return {.mesh = tool_mesh(c),
          .position_m = Vec3(-c.particle_radius_m, 0, c.bed_depth_m - c.tool_depth_m)};
}

Specimen bonded_bed(const SweepTillageConfig& c, Packing packing,
                    std::span<const SoilMaterial> lanes) {
  for (Vec3& x : packing.position_m) x.y() -= 0.5 * c.bin_width_m;
  Specimen s = make_specimen(
      packing, lanes, bin_walls(c),
      {c.bond_gap_over_radius, {floor_wall}, {.surface_m = c.bed_depth_m}}, {waiting_tool(c)});
  s.model.gravity_m_per_s2 = -c.gravity_m_per_s2 * Vec3::UnitZ();
  for (int lane = 0; lane < s.model.num_lanes(); ++lane) {
    LaneLaw& law = s.model.lanes[static_cast<std::size_t>(lane)];
    law.normal_damping = damping_number(c.restitution);
    law.tangential_damping = law.normal_damping * law.shear_stiffness_ratio;
    set_nominal_rate(s.model, lane, laboratory_rate_per_s);  // the tool's speed is the real one
    law.dt_s = ladder_time_step_s(0.8 * stable_time_step_s(s.model, s.state, lane));
  }
  return s;
}

std::vector<Vec3> positions_m(const LaneRun& run, int lane) {
  std::vector<Vec3> x;
  for (int i = 0; i < run.specimen.model.num_particles(); ++i)
    x.push_back(run.specimen.state.position_m(i, lane));
  return x;
}

struct LaneProgress {
  Stage stage = Stage::settle;
  CalmWatch settling{1e-5, 5};
  CalmWatch resting{1e-3, 5};
  double stage_start_s = 0.0;
  double next_frame_m = 0.0;
  SweepRecord record;
};

class SweepProtocol {
 public:
  SweepProtocol(const SweepTillageConfig& config, const LaneRun& run, const SweepObserver* observer)
      : config_(config),
        stretch_(config),
        area_in_soil_m2_(area_below_m2(run.specimen.model.tools.front().mesh, config.tool_depth_m)),
        placed_m_(positions_m(run, 0)),
        observer_(observer),
        progress_(run.results.size()) {}

  static constexpr int interval_steps = 50;

  void operator()(LaneRun& run, int lane) {
    LaneProgress& p = progress_[static_cast<std::size_t>(lane)];
    switch (p.stage) {
      case Stage::settle:
        return settle(run, lane, p);
      case Stage::travel:
        return travel(run, lane, p);
      case Stage::rest:
        return rest(run, lane, p);
    }
  }

  const SweepRecord& record(std::size_t lane) const { return progress_[lane].record; }

 private:
  double nose_m(const LaneRun& run, int lane) const {
    return run.specimen.state.tool_position_m(sweep_tool, lane).x();
  }

  void show(const LaneRun& run, int lane, const LaneProgress& p, SweepMoment moment) const {
    if (!observer_) return;
    observer_->frame({moment, run.time_s(lane), nose_m(run, lane), p.record.surface_m, run.specimen,
                      p.record.settled_m, p.record.tracers});
  }

  void settle(LaneRun& run, int lane, LaneProgress& p) {
    if (p.settling.calm(agitation(run, lane))) return begin_travel(run, lane, p);
    if (run.specimen.state.num_steps <= 200'000) return;
    run.finish(lane, RunStatus::not_settled,
               fmt::format("the bed still moved after {} steps (agitation {:.3g})",
                           run.specimen.state.num_steps, agitation(run, lane)));
  }

  void begin_travel(LaneRun& run, int lane, LaneProgress& p) {
    SweepRecord& r = p.record;
    r.settled_m = positions_m(run, lane);
    r.surface_m = config_.bed_depth_m - mean_settlement_m(run, r.settled_m);
    r.tracers =
        place_tracers({config_.tracer_depth_m, config_.tracer_lateral_m, config_.tracer_spacing_m,
                       config_.tracer_size_m},
                      stretch_.steady_from_m, stretch_.tracers_to_m, r.surface_m, r.settled_m);
    State& state = run.specimen.state;
    const double edge_m = r.surface_m - config_.tool_depth_m;
    state.set_tool_position_m(sweep_tool, lane, Vec3(nose_m(run, lane), 0, edge_m));
    state.tool_drive(sweep_tool, lane).velocity_m_per_s = config_.speed_m_per_s * Vec3::UnitX();
    set_local_damping(run, lane, 0.0);
    p.stage = Stage::travel;
    show(run, lane, p, SweepMoment::settled);
  }

  /// Of the uppermost layer, two mean diameters thick.
  double mean_settlement_m(const LaneRun& run, const std::vector<Vec3>& settled_m) const {
    double sum_m = 0.0, n = 0.0;
    for (std::size_t i = 0; i < settled_m.size(); ++i)
      if (placed_m_[i].z() > config_.bed_depth_m - 4 * run.specimen.mean_radius_m) {
        sum_m += placed_m_[i].z() - settled_m[i].z();
        ++n;
      }
    return sum_m / std::max(n, 1.0);
  }

  void travel(LaneRun& run, int lane, LaneProgress& p) {
    const double nose = nose_m(run, lane);
    // The position is that at the interval's end, the force its mean, half an interval earlier.
    const double lag_m = 0.5 * interval_steps * run.dt_s(lane) * config_.speed_m_per_s;
    const Vec3 force_N = run.tool_force_N(sweep_tool, lane);
    const WingFlow flow = flow_over(run, lane, nose, p.record.surface_m - config_.tool_depth_m);
    const int contacts = run.specimen.state.num_tool_contacts(sweep_tool, lane);
    run.results[static_cast<std::size_t>(lane)].curves.front().rows.push_back(
        {nose - lag_m, -force_N.x(), force_N.z(), force_N.y(), static_cast<double>(contacts),
         contacts / area_in_soil_m2_, flow.forward_m_per_s, flow.outward_m_per_s});
    if (observer_ && nose >= p.next_frame_m) {
      show(run, lane, p, SweepMoment::travelling);
      p.next_frame_m += observer_->interval_m;
    }
    if (nose < stretch_.travel_to_m) return;
    run.specimen.state.tool_drive(sweep_tool, lane).velocity_m_per_s = Vec3::Zero();
    p.stage = Stage::rest;
    p.stage_start_s = run.time_s(lane);
    show(run, lane, p, SweepMoment::stopped);
  }

  /// Of the parametric sweep; nothing where the tool is another mesh.
  WingFlow flow_over(const LaneRun& run, int lane, double nose_m, double edge_m) const {
    if (!config_.tool_mesh.triangle.empty()) return {};
    const Vec3 origin_m(nose_m, 0, edge_m);
    std::vector<Vec3> position_m, velocity_m_per_s;
    std::vector<double> radius_m;
    for (int i = 0; i < run.specimen.model.num_particles(); ++i) {
      const Vec3 x_m = run.specimen.state.position_m(i, lane) - origin_m;
      if (x_m.x() > 0 || x_m.x() < -stretch_.tool_length_m) continue;
      position_m.push_back(x_m);
      velocity_m_per_s.push_back(run.specimen.state.velocity_m_per_s(i, lane));
      radius_m.push_back(run.specimen.model.radius_m[static_cast<std::size_t>(i)]);
    }
    return wing_flow(config_.sweep, position_m, velocity_m_per_s, radius_m);
  }

  void rest(LaneRun& run, int lane, LaneProgress& p) {
    const double restless = agitation(run, lane);
    if (p.resting.calm(restless)) {
      p.record.at_rest_m = positions_m(run, lane);
      show(run, lane, p, SweepMoment::at_rest);
      run.finish(lane, RunStatus::completed, "drawn through, the soil is at rest");
    } else if (run.time_s(lane) - p.stage_start_s > longest_rest_s) {
      run.finish(
          lane, RunStatus::not_settled,
          fmt::format("the soil still moved {} s after the tool had stopped (agitation {:.3g})",
                      longest_rest_s, restless));
    }
  }

  const SweepTillageConfig& config_;
  SweepStretch stretch_;
  double area_in_soil_m2_;
  std::vector<Vec3> placed_m_;
  const SweepObserver* observer_;
  std::vector<LaneProgress> progress_;
};

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       const SweepTillageConfig& config, const Packing& packing,
                                       const RunOptions& options, const SweepObserver* observer) {
  // 1. bond the packing as it lies, turn gravity on
  LaneRun run(bonded_bed(config, packing, lanes));
  for (ExperimentResult& r : run.results) r.curves = {empty_force_curve()};

  // 2. settle, draw the tool through, let the soil come to rest
  SweepProtocol protocol(config, run, observer);
  run_protocol(run, SweepProtocol::interval_steps, 50'000'000, options, std::ref(protocol));

  // 3. read forces, surface and tracers
  for (std::size_t k = 0; k < run.results.size(); ++k) {
    ExperimentResult& r = run.results[k];
    r.inertial_number = config.speed_m_per_s / config.tool_depth_m * 2 * packing.mean_radius_m /
                        std::sqrt(config.gravity_m_per_s2 * config.tool_depth_m);
    if (r.status == RunStatus::completed)
      read_sweep(config, packing.radius_m, protocol.record(k), r);
  }
  return run.results;
}

/// The member as an aggregate of this bed.
SoilMaterial in_bed(SoilMaterial member, const SweepTillageConfig& config) {
  member.density_kg_per_m3 = aggregate_density_kg_per_m3(config);
  return member;
}

}  // namespace

std::vector<ExperimentResult> run_sweep_tillage(std::span<const SoilMaterial> members,
                                                const SweepTillageConfig& config,
                                                PackingStore& packings, const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  std::vector<SoilMaterial> aggregates;
  for (const SoilMaterial& m : members) aggregates.push_back(in_bed(m, config));
  return run_members(aggregates, options, [&](std::span<const SoilMaterial> lanes) {
    return run_pack(lanes, config, *packing, options, nullptr);
  });
}

ExperimentResult watch_sweep_tillage(const SoilMaterial& member, const SweepTillageConfig& config,
                                     PackingStore& packings, const SweepObserver& observer,
                                     const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  const SoilMaterial aggregate = in_bed(member, config);
  return run_pack({&aggregate, 1}, config, *packing, options, &observer).front();
}

}  // namespace tilth
