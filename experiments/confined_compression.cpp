// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/confined_compression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/curve_features.hpp"
#include "experiments/platens.hpp"

namespace tilth {
namespace {

enum WallId : int { bottom = bottom_platen, top = top_platen, ring };
enum Column : std::size_t { axial_strain, axial_stress, radial_stress, broken };

std::vector<Wall> walls(const ConfinedCompressionConfig& c) {
  std::vector<Wall> all = platens(c.ring_height_m);
  for (Wall& platen : all) platen.friction_scale = c.platen_friction_scale;
  all.push_back({.shape = WallShape::cylinder, .radius_m = c.ring_radius_m});
  return all;
}

/// Stresses at which the platens turn, loading and unloading by turns; the test ends at the last.
std::vector<double> turning_stresses_Pa(const ConfinedCompressionConfig& c) {
  std::vector<double> turns = {c.load_to_stress_Pa, c.unload_to_stress_Pa};
  if (c.second_load_to_stress_Pa > c.load_to_stress_Pa) {
    turns.push_back(c.second_load_to_stress_Pa);
    turns.push_back(c.unload_to_stress_Pa);
    turns.push_back(c.second_load_to_stress_Pa);
  } else {
    turns.push_back(c.load_to_stress_Pa);
  }
  return turns;
}

class OedometerProtocol {
 public:
  OedometerProtocol(const ConfinedCompressionConfig& config, std::vector<double> speed_m_per_s)
      : config_(config),
        turns_Pa_(turning_stresses_Pa(config)),
        speed_m_per_s_(std::move(speed_m_per_s)),
        turn_rows_(speed_m_per_s_.size()) {}

  static constexpr int interval_steps = 20;

  void drive(LaneRun& run, int lane, double sense) const {
    const double v = 0.5 * sense * speed_m_per_s_[static_cast<std::size_t>(lane)];
    run.specimen.state.drive(bottom, lane).velocity_m_per_s = v * Vec3::UnitZ();
    run.specimen.state.drive(top, lane).velocity_m_per_s = -v * Vec3::UnitZ();
  }

  void operator()(LaneRun& run, int lane) {
    const std::size_t k = static_cast<std::size_t>(lane);
    Curve& curve = run.results[k].curves.front();
    record(run, lane, curve);
    const std::vector<double>& row = curve.rows.back();
    std::vector<std::size_t>& turn_rows = turn_rows_[k];
    const double turn_Pa = turns_Pa_[turn_rows.size()];
    const bool loading = turn_rows.size() % 2 == 0;
    if (loading ? row[axial_stress] >= turn_Pa : row[axial_stress] <= turn_Pa) {
      turn_rows.push_back(curve.rows.size() - 1);
      if (turn_rows.size() < turns_Pa_.size()) drive(run, lane, loading ? -1 : 1);
      else run.finish(lane, RunStatus::completed, "loaded, unloaded and reloaded");
    } else if (row[axial_strain] > config_.max_axial_strain) {
      run.finish(lane, RunStatus::not_settled,
                 fmt::format("reached strain {:.3g} at {:.4g} Pa, before {:.4g} Pa",
                             row[axial_strain], row[axial_stress],
                             *std::ranges::max_element(turns_Pa_)));
    }
  }

  void read_features(ExperimentResult& r, std::size_t lane) const {
    const Curve& curve = r.curves.front();
    const std::vector<std::size_t>& turn_rows = turn_rows_[lane];
    const double from_Pa = config_.load_from_stress_Pa;
    const double to_Pa = config_.load_to_stress_Pa;
    const std::size_t load_end = turn_rows[0];
    const double strain_from =
        first_crossing(curve, axial_strain, axial_stress, from_Pa, 0, load_end + 1);
    const double strain_to =
        first_crossing(curve, axial_strain, axial_stress, to_Pa, 0, load_end + 1);
    const auto& top_row = curve.rows[load_end];
    const auto secant = [&curve](std::size_t from_row, std::size_t to_row) {
      const auto& a = curve.rows[from_row];
      const auto& b = curve.rows[to_row];
      return (b[axial_stress] - a[axial_stress]) / (b[axial_strain] - a[axial_strain]);
    };
    // Reloading may go on to the second loop; its secant ends where the first one would.
    std::size_t reload_end = turn_rows[1];
    while (curve.rows[reload_end][axial_stress] < to_Pa) ++reload_end;
    r.features = {{"constrained_modulus_Pa", (to_Pa - from_Pa) / (strain_to - strain_from)},
                  {"unload_modulus_Pa", secant(load_end, turn_rows[1])},
                  {"reload_modulus_Pa", secant(turn_rows[1], reload_end)},
                  {"compression_strain", strain_to},
                  {"radial_stress_ratio", top_row[radial_stress] / top_row[axial_stress]}};
    if (turn_rows.size() < 5) return;
    r.features.push_back({"second_unload_modulus_Pa", secant(turn_rows[2], turn_rows[3])});
    r.features.push_back({"second_reload_modulus_Pa", secant(turn_rows[3], turn_rows[4])});
  }

 private:
  void record(const LaneRun& run, int lane, Curve& curve) const {
    const State& state = run.specimen.state;
    const double height_m =
        state.wall_position_m(top, lane).z() - state.wall_position_m(bottom, lane).z();
    // Positions are those at the interval's end; the stress is its mean, half an interval earlier.
    const double lag_m = 0.5 * interval_steps * run.dt_s(lane) *
                         (state.drives[static_cast<std::size_t>(bottom * run.num_lanes() + lane)]
                              .velocity_m_per_s.z() *
                          2);
    const double area_m2 = std::numbers::pi * config_.ring_radius_m * config_.ring_radius_m;
    const double mantle_m2 = 2 * std::numbers::pi * config_.ring_radius_m * height_m;
    const std::size_t k = static_cast<std::size_t>(lane);
    curve.rows.push_back(
        {(config_.ring_height_m - height_m - lag_m) / config_.ring_height_m,
         axial_force_N(run, lane) / area_m2, radial_force_N(run, lane) / mantle_m2, run.workspace.num_broken[k]});
  }

  /// Forces on the ring point everywhere outwards and cancel in the sum; their sum of magnitudes is
  /// what counts, taken from the contacts of this moment.
  static double radial_force_N(const LaneRun& run, int lane);

  const ConfinedCompressionConfig& config_;
  std::vector<double> turns_Pa_;
  std::vector<double> speed_m_per_s_;
  std::vector<std::vector<std::size_t>> turn_rows_;  ///< per lane, row of every turn so far
};

double OedometerProtocol::radial_force_N(const LaneRun& run, int lane) {
  const State& state = run.specimen.state;
  const LaneLaw& law = run.specimen.model.lanes[static_cast<std::size_t>(lane)];
  double sum_N = 0.0;
  const auto begin = state.wall_contacts.row_begin[ring];
  const auto end = state.wall_contacts.row_begin[ring + 1];
  for (auto c = begin; c < end; ++c) {
    const Vec3 x = state.position_m(state.wall_contacts.particle[static_cast<std::size_t>(c)], lane);
    const WallRecord& record = run.workspace.wall_pairs[static_cast<std::size_t>(c)];
    const double distance_m =
        run.specimen.model.walls[ring].radius_m - std::hypot(x.x(), x.y());
    const double overlap_m = record.reference_m - distance_m;
    if (overlap_m > 0) sum_N += law.contact_stiffness * record.stiffness_factor * overlap_m;
  }
  return sum_N;
}

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       const ConfinedCompressionConfig& config,
                                       const Packing& packing, const RunOptions& options) {
  LaneRun run(make_specimen(packing, lanes, walls(config), {config.bond_gap_over_radius}));
  std::vector<double> speed_m_per_s;
  for (const SoilMaterial& m : lanes)
    speed_m_per_s.push_back(config.platen_speed_over_wave_speed * wave_speed_m_per_s(m));
  for (ExperimentResult& r : run.results)
    r.curves = {{"stress_strain",
                 {"axial_strain", "axial_stress_Pa", "radial_stress_Pa", "bonds_broken"},
                 {}}};
  OedometerProtocol protocol(config, speed_m_per_s);
  for (int lane = 0; lane < run.num_lanes(); ++lane) {
    set_nominal_rate(run.specimen.model, lane,
                     speed_m_per_s[static_cast<std::size_t>(lane)] / config.ring_height_m);
    protocol.drive(run, lane, 1);
  }
  run_protocol(run, OedometerProtocol::interval_steps, 4'000'000, options, std::ref(protocol));
  for (std::size_t k = 0; k < run.results.size(); ++k) {
    ExperimentResult& r = run.results[k];
    if (r.status == RunStatus::completed) protocol.read_features(r, k);
    r.inertial_number =
        axial_inertial_number(speed_m_per_s[k], config.ring_height_m, packing.mean_radius_m,
                              lanes[k].density_kg_per_m3, config.load_to_stress_Pa);
  }
  return run.results;
}

}  // namespace

std::vector<Field> fields(ConfinedCompressionConfig& c) {
  return {{"ring_radius_m", &c.ring_radius_m, 1e-3, 10},
          {"ring_height_m", &c.ring_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, -1, 1},
          {"load_from_stress_Pa", &c.load_from_stress_Pa, 1, 1e9},
          {"load_to_stress_Pa", &c.load_to_stress_Pa, 1, 1e9},
          {"unload_to_stress_Pa", &c.unload_to_stress_Pa, 0, 1e9},
          {"second_load_to_stress_Pa", &c.second_load_to_stress_Pa, 0, 1e9},
          {"platen_speed_over_wave_speed", &c.platen_speed_over_wave_speed, 1e-6, 1e-2},
          {"max_axial_strain", &c.max_axial_strain, 1e-3, 0.6},
          {"platen_friction_scale", &c.platen_friction_scale, 0, 10},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

PackingSpec packing_spec(const ConfinedCompressionConfig& c) {
  return cylinder_packing(c.ring_radius_m, c.ring_height_m, c.num_particles, c.porosity,
                          c.size_spread, c.packing_seed);
}

std::vector<ExperimentResult> run_confined_compression(std::span<const SoilMaterial> members,
                                                       const ConfinedCompressionConfig& config,
                                                       PackingStore& packings,
                                                       const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  return run_members(members, options, [&](std::span<const SoilMaterial> lanes) {
    return run_pack(lanes, config, *packing, options);
  });
}

}  // namespace tilth
