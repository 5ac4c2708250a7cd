// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/angle_of_repose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/heap_profile.hpp"
#include "experiments/settled_bed.hpp"

namespace tilth {
namespace {

enum WallId : int { back, side_front, side_back, retaining };
enum Column : std::size_t { time, wall_position, angle, restlessness };

PackingSpec packing_spec(const AngleOfReposeConfig& c) {
  return {.shape = ContainerShape::box,
          .size_m = Vec3(c.column_length_m, c.slab_thickness_m, c.column_height_m),
          .num_particles = c.num_particles,
          .porosity = c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

double floor_length_m(const AngleOfReposeConfig& c) {
  return c.floor_over_column_length * c.column_length_m;
}

/// A floor of touching, fixed grains of the mean radius on a square grid, their tops at z = 0, then the column.
Packing on_rough_floor(const Packing& column, const AngleOfReposeConfig& c, int& num_floor_grains) {
  const double r = column.mean_radius_m;
  // Across the slab they overlap rather than leave a gap that a grain could fall through.
  const auto rows = [r](double length_m) { return static_cast<int>(std::ceil(length_m / (2 * r))); };
  const int nx = rows(floor_length_m(c));
  const int ny = rows(c.slab_thickness_m);
  Packing all;
  all.mean_radius_m = r;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j) {
      all.radius_m.push_back(r);
      all.position_m.emplace_back((2 * i + 1) * r, (j + 0.5) * c.slab_thickness_m / ny, -r);
    }
  num_floor_grains = nx * ny;
  all.radius_m.insert(all.radius_m.end(), column.radius_m.begin(), column.radius_m.end());
  all.position_m.insert(all.position_m.end(), column.position_m.begin(), column.position_m.end());
  return all;
}

std::vector<Wall> slab_walls(const AngleOfReposeConfig& c, double mean_radius_m) {
  // The retaining wall ends above the centres of the floor's grains, which it passes over.
  const double reach_m = 10 * c.column_height_m;
  return {{.direction = Vec3::UnitX()},
          {.direction = Vec3::UnitY()},
          {.direction = -Vec3::UnitY(), .position_m = c.slab_thickness_m * Vec3::UnitY()},
          {.direction = -Vec3::UnitX(),
           .position_m = Vec3(c.column_length_m, 0, reach_m - 0.5 * mean_radius_m),
           .tangent_a = Vec3::UnitY(),
           .tangent_b = Vec3::UnitZ(),
           .half_b_m = reach_m,
           .has_edges = false}};
}

enum class Stage { settling, retreating, resting };

struct LaneProgress {
  Stage stage = Stage::settling;
  CalmWatch watch;
  double stage_start_s = 0.0;
};

class HeapProtocol {
 public:
  HeapProtocol(const AngleOfReposeConfig& config, double mean_radius_m, std::size_t num_lanes)
      : config_(config),
        frame_{.length_m = floor_length_m(config),
               .thickness_m = config.slab_thickness_m,
               .cell_m = 2 * mean_radius_m},
        progress_(num_lanes, LaneProgress{.watch = {config.agitation_limit, watched_intervals}}) {}

  static constexpr int interval_steps = 100;
  static constexpr int watched_intervals = 20;

  double wall_speed_m_per_s() const {
    return config_.wall_speed_over_fall_speed *
           std::sqrt(config_.gravity_m_per_s2 * frame_.cell_m);
  }

  void operator()(LaneRun& run, int lane) {
    LaneProgress& p = progress_[static_cast<std::size_t>(lane)];
    const double restless = agitation(run, lane);
    if (p.stage != Stage::settling) record(run, lane, restless);
    if (p.stage == Stage::retreating) retreat(run, lane, p);
    else if (!p.watch.calm(restless)) check_time(run, lane, p, restless);
    else if (p.stage == Stage::settling) begin(run, lane, p, Stage::retreating, wall_speed_m_per_s());
    else if (!drifts(run, lane)) finish(run, lane);
  }

 private:
  Curve& history(LaneRun& run, int lane) const {
    return run.results[static_cast<std::size_t>(lane)].curves.front();
  }
  double wall_position_m(const LaneRun& run, int lane) const {
    return run.specimen.state.wall_position_m(retaining, lane).x();
  }

  void begin(LaneRun& run, int lane, LaneProgress& p, Stage stage, double speed_m_per_s) const {
    p.stage = stage;
    p.stage_start_s = run.time_s(lane);
    p.watch.begin_again();
    run.specimen.state.drive(retaining, lane).velocity_m_per_s = speed_m_per_s * Vec3::UnitX();
  }

  HeapShape shape(const LaneRun& run, int lane) const {
    return heap_shape(heap_profile_m(run.specimen, lane, frame_), frame_.cell_m);
  }

  void record(LaneRun& run, int lane, double restless) const {
    history(run, lane).rows.push_back(
        {run.time_s(lane), wall_position_m(run, lane), shape(run, lane).angle_rad, restless});
  }

  /// Until the wall is two diameters clear of the foremost grain, or at the floor's end.
  void retreat(LaneRun& run, int lane, LaneProgress& p) const {
    const double wall_m = wall_position_m(run, lane);
    double front_m = 0.0;
    for (int i = run.specimen.model.num_fixed; i < run.specimen.model.num_particles(); ++i)
      front_m = std::max(front_m, run.specimen.state.position_m(i, lane).x());
    if (wall_m < frame_.length_m && wall_m < front_m + 2.5 * frame_.cell_m) return;
    begin(run, lane, p, Stage::resting, 0.0);
  }

  bool drifts(LaneRun& run, int lane) const {
    const auto& rows = history(run, lane).rows;
    const std::size_t last = rows.size() - 1;
    const std::size_t then = last - std::min<std::size_t>(last, watched_intervals);
    return std::abs(rows[last][angle] - rows[then][angle]) > config_.angle_drift_limit_rad;
  }

  void check_time(LaneRun& run, int lane, const LaneProgress& p, double restless) const {
    const double limit_s = 150 * std::sqrt(config_.column_height_m / config_.gravity_m_per_s2);
    if (run.time_s(lane) - p.stage_start_s < limit_s) return;
    run.finish(lane, RunStatus::not_settled,
               fmt::format("{}: kinetic energy per grain still {:.2g} m g r after {:.2g} s",
                           p.stage == Stage::settling ? "the column" : "the heap", restless,
                           limit_s));
  }

  void finish(LaneRun& run, int lane) const {
    ExperimentResult& r = run.results[static_cast<std::size_t>(lane)];
    const std::vector<double> profile_m = heap_profile_m(run.specimen, lane, frame_);
    const HeapShape heap = heap_shape(profile_m, frame_.cell_m);
    Curve curve{"profile", {"x_m", "height_m"}, {}};
    for (std::size_t k = 0; k < profile_m.size(); ++k)
      curve.rows.push_back({(static_cast<double>(k) + 0.5) * frame_.cell_m, profile_m[k]});
    r.curves.push_back(std::move(curve));
    if (heap.num_points < 3) {
      run.finish(lane, RunStatus::not_settled,
                 fmt::format("the heap is {:.2g} m long, too short for a line", heap.runout_m));
      return;
    }
    r.features = {{"repose_angle_rad", heap.angle_rad},
                  {"heap_height_m", heap.height_m},
                  {"runout_m", heap.runout_m}};
    run.finish(lane, RunStatus::completed, "the heap is at rest");
  }

  const AngleOfReposeConfig& config_;
  HeapFrame frame_;
  std::vector<LaneProgress> progress_;
};

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       const AngleOfReposeConfig& config, const Packing& column,
                                       const RunOptions& options) {
  LooseBedSpec bed{.gravity_m_per_s2 = config.gravity_m_per_s2,
                   .depth_m = config.column_height_m,
                   .stiffness_over_weight = config.stiffness_over_weight,
                   .restitution = config.restitution,
                   .local_damping = config.local_damping};
  const Packing all = on_rough_floor(column, config, bed.num_fixed);
  LaneRun run(make_loose_bed(all, lanes, slab_walls(config, all.mean_radius_m), bed));
  for (ExperimentResult& r : run.results)
    r.curves = {{"retreat", {"time_s", "wall_position_m", "repose_angle_rad", "agitation"}, {}}};
  HeapProtocol protocol(config, all.mean_radius_m, lanes.size());
  run_protocol(run, HeapProtocol::interval_steps, 10'000'000, options, std::ref(protocol));
  for (ExperimentResult& r : run.results)
    r.inertial_number = protocol.wall_speed_m_per_s() / config.column_height_m * 2 *
                        all.mean_radius_m /
                        std::sqrt(config.gravity_m_per_s2 * config.column_height_m);
  return run.results;
}

}  // namespace

std::vector<Field> fields(AngleOfReposeConfig& c) {
  return {{"column_length_m", &c.column_length_m, 1e-3, 10},
          {"column_height_m", &c.column_height_m, 1e-3, 10},
          {"slab_thickness_m", &c.slab_thickness_m, 1e-3, 10},
          {"floor_over_column_length", &c.floor_over_column_length, 1.5, 20},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"gravity_m_per_s2", &c.gravity_m_per_s2, 1e-3, 1e3},
          {"stiffness_over_weight", &c.stiffness_over_weight, 50, 1e6},
          {"restitution", &c.restitution, 0.05, 1},
          {"local_damping", &c.local_damping, 0, 0.95},
          {"wall_speed_over_fall_speed", &c.wall_speed_over_fall_speed, 1e-3, 2},
          {"agitation_limit", &c.agitation_limit, 1e-12, 1e-2},
          {"angle_drift_limit_rad", &c.angle_drift_limit_rad, 1e-5, 0.1},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

std::vector<ExperimentResult> run_angle_of_repose(std::span<const SoilMaterial> members,
                                                  const AngleOfReposeConfig& config,
                                                  PackingStore& packings,
                                                  const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  // Grains that flow part ways from lane to lane, and a pack visits the pairs of all its lanes: eight
  // lanes cost as much as eight runs (docs/experiments/angle_of_repose.md). Wider only if asked for.
  RunOptions own = options;
  if (own.max_lanes == 0) own.max_lanes = 1;
  return run_members(members, own, [&](std::span<const SoilMaterial> lanes) {
    return run_pack(lanes, config, *packing, options);
  });
}

}  // namespace tilth
