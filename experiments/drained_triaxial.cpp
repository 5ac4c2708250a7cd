// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/drained_triaxial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "dem_core/time_step.hpp"
#include "experiments/curve_features.hpp"
#include "experiments/density_preparation.hpp"
#include "experiments/triaxial_features.hpp"

namespace tilth {
namespace {

/// So loose that grains hardly touch, and grow to it within a second.
constexpr double cloud_porosity = 0.50;

bool is_prepared(const DrainedTriaxialConfig& c) { return !c.relative_density.empty(); }

PackingSpec packing_spec(const DrainedTriaxialConfig& c) {
  return {.shape = ContainerShape::box,
          .size_m = Vec3::Constant(c.side_m),
          .num_particles = c.num_particles,
          .porosity = is_prepared(c) ? cloud_porosity : c.porosity,
          .size_spread = c.size_spread,
          .seed = c.packing_seed};
}

/// One test of one member.
struct TriaxialTask {
  SoilMaterial material;
  double cell_pressure_Pa = 0.0;
  std::optional<double> relative_density;
};

class TriaxialProtocol {
 public:
  TriaxialProtocol(const DrainedTriaxialConfig& config, std::vector<TriaxialTask> tasks,
                   const DensestStates& densest)
      : config_(config), tasks_(std::move(tasks)), progress_(tasks_.size()) {
    for (const TriaxialTask& t : tasks_) {
      bonded_.emplace_back(t.cell_pressure_Pa, t.material.density_kg_per_m3);
      if (!t.relative_density) continue;
      prepared_.emplace_back(
          *t.relative_density,
          densest.void_ratio_at(t.cell_pressure_Pa / t.material.contact_modulus_Pa),
          t.cell_pressure_Pa, t.material);
    }
  }

  void start(LaneRun& run) {
    for (int lane = 0; lane < run.num_lanes(); ++lane) {
      const std::size_t k = static_cast<std::size_t>(lane);
      set_nominal_rate(run.specimen.model, lane, strain_rate_per_s(run, tasks_[k]));
      if (tasks_[k].relative_density) prepared_[k].start(run, lane);
      else bonded_[k].start(run, lane);
    }
  }

  void operator()(LaneRun& run, int lane) {
    const std::size_t k = static_cast<std::size_t>(lane);
    if (progress_[k].shearing) return shear(run, lane);
    const bool ready = tasks_[k].relative_density ? prepared_[k].advance(run, lane)
                                                  : bonded_[k].advance(run, lane);
    if (ready) begin_shear(run, lane);
  }

 private:
  struct LaneProgress {
    bool shearing = false;
    Vec3 size_m = Vec3::Zero();  ///< at the start of shearing
    double axial_strain = 0.0, volumetric_strain = 0.0;  ///< at the end of the last interval
  };

  double strain_rate_per_s(const LaneRun& run, const TriaxialTask& t) const {
    return config_.inertial_number / (2 * run.specimen.mean_radius_m) *
           std::sqrt(t.cell_pressure_Pa / t.material.density_kg_per_m3);
  }

  void begin_shear(LaneRun& run, int lane) {
    const std::size_t k = static_cast<std::size_t>(lane);
    const TriaxialTask& task = tasks_[k];
    const double e = void_ratio(run, lane);
    run.results[k].features = {{"initial_void_ratio", e}};
    if (task.relative_density) {
      set_time_step(run, lane,
                    ladder_time_step_s(0.8 * stable_time_step_s(run.specimen.model,
                                                                run.specimen.state, lane)));
      const OwnStates& own = prepared_[k].states();
      run.results[k].features.push_back({"relative_density", own.relative_density(e)});
      run.results[k].features.push_back({"loosest_void_ratio", own.loosest_void_ratio});
      run.results[k].features.push_back({"densest_void_ratio", own.densest_void_ratio});
    }
    LaneProgress& p = progress_[k];
    p.shearing = true;
    p.size_m = box_size_m(run, lane);
    const double speed_m_per_s = strain_rate_per_s(run, task) * p.size_m.z();
    // The sides must keep up with a specimen that dilates as fast as it shortens.
    for (const int axis : {0, 1})
      hold_box_stress(run, lane, axis, task.cell_pressure_Pa, 3 * speed_m_per_s);
    run.specimen.state.drive(box_base, lane) = {.velocity_m_per_s = 0.5 * speed_m_per_s * Vec3::UnitZ()};
    run.specimen.state.drive(box_lid, lane) = {.velocity_m_per_s = -0.5 * speed_m_per_s * Vec3::UnitZ()};
    run.results[k].curves.front().rows.push_back(
        {0.0, 0.0, box_stress_Pa(run, lane, 2), radial_stress_Pa(run, lane)});
    run.results[k].inertial_number = config_.inertial_number;
  }

  static double radial_stress_Pa(const LaneRun& run, int lane) {
    return 0.5 * (box_stress_Pa(run, lane, 0) + box_stress_Pa(run, lane, 1));
  }

  void shear(LaneRun& run, int lane) {
    const std::size_t k = static_cast<std::size_t>(lane);
    LaneProgress& p = progress_[k];
    const Vec3 size_m = box_size_m(run, lane);
    const double axial = 1 - size_m.z() / p.size_m.z();
    const double volumetric = 1 - size_m.prod() / p.size_m.prod();
    // Forces are means over the interval, so strains are taken at its middle.
    run.results[k].curves.front().rows.push_back(
        {0.5 * (axial + p.axial_strain), 0.5 * (volumetric + p.volumetric_strain),
         box_stress_Pa(run, lane, 2), radial_stress_Pa(run, lane)});
    p.axial_strain = axial;
    p.volumetric_strain = volumetric;
    for (const int axis : {0, 1})
      update_box_stress(run, lane, axis, tasks_[k].cell_pressure_Pa);
    if (axial >= config_.max_axial_strain)
      run.finish(lane, RunStatus::completed, "at the axial strain limit");
  }

  const DrainedTriaxialConfig& config_;
  std::vector<TriaxialTask> tasks_;
  std::vector<IsotropicCompression> bonded_;
  std::vector<DensityPreparation> prepared_;
  std::vector<LaneProgress> progress_;
};

std::vector<ExperimentResult> run_pack(const std::vector<TriaxialTask>& tasks,
                                       const DrainedTriaxialConfig& config, const Packing& packing,
                                       const DensestStates& densest, const RunOptions& options) {
  std::vector<SoilMaterial> lanes;
  for (const TriaxialTask& t : tasks) lanes.push_back(t.material);
  const double gap = is_prepared(config) ? -1 : config.bond_gap_over_radius;
  LaneRun run(make_specimen(packing, lanes, box_plates(packing_spec(config).size_m), {gap}));
  for (std::size_t k = 0; k < tasks.size(); ++k)
    run.results[k].curves = {
        {"triaxial_" + triaxial_state_label(tasks[k].cell_pressure_Pa, tasks[k].relative_density),
         triaxial_columns,
         {}}};
  TriaxialProtocol protocol(config, tasks, densest);
  protocol.start(run);
  run_protocol(run, IsotropicCompression::interval_steps, 8'000'000, options, std::ref(protocol));
  return run.results;
}

/// Stress state and modulus of one test, for the lines through a series.
struct SeriesPoint {
  double cell_pressure_Pa = 0.0;
  double peak_stress_ratio = 0.0;
  double initial_modulus_Pa = 0.0;
};

void add_series_features(const std::vector<SeriesPoint>& series, std::vector<Feature>& features) {
  const auto [low, high] = std::ranges::minmax(series, {}, &SeriesPoint::cell_pressure_Pa);
  if (!(low.cell_pressure_Pa < high.cell_pressure_Pa)) return;
  std::vector<double> s_Pa, t_Pa, ln_pressure, ln_modulus;
  for (const SeriesPoint& point : series) {
    // q = eta p and p = radial + q / 3 give q from the ratio at constant radial stress.
    const double q_Pa =
        point.cell_pressure_Pa * point.peak_stress_ratio / (1 - point.peak_stress_ratio / 3);
    s_Pa.push_back(point.cell_pressure_Pa + 0.5 * q_Pa);
    t_Pa.push_back(0.5 * q_Pa);
    ln_pressure.push_back(std::log(point.cell_pressure_Pa));
    ln_modulus.push_back(std::log(point.initial_modulus_Pa));
  }
  const Line peaks = fit_line(s_Pa, t_Pa);
  const double angle_rad = std::asin(peaks.slope);
  features.push_back({"friction_angle_rad", angle_rad});
  features.push_back({"cohesion_Pa", peaks.intercept / std::cos(angle_rad)});
  features.push_back({"stiffness_exponent", fit_line(ln_pressure, ln_modulus).slope});
}

/// Joins the tests of one member; the first failure is the member's.
ExperimentResult join(std::span<const TriaxialTask> tasks, std::span<ExperimentResult> tests) {
  ExperimentResult member;
  member.status = RunStatus::completed;
  member.message = "sheared at every cell pressure";
  std::vector<SeriesPoint> series;
  for (std::size_t k = 0; k < tests.size(); ++k) {
    ExperimentResult& test = tests[k];
    const TriaxialTask& task = tasks[k];
    const std::string label = triaxial_state_label(task.cell_pressure_Pa, task.relative_density);
    member.dt_s = test.dt_s;
    member.num_steps += test.num_steps;
    member.inertial_number = std::max(member.inertial_number, test.inertial_number);
    std::vector<Feature> found = triaxial_features(test.curves.front());
    if (test.status != RunStatus::completed || found.empty()) {
      member.status = test.status == RunStatus::completed ? RunStatus::not_settled : test.status;
      member.message = fmt::format("at {} Pa: {}", label, test.message);
      member.features.clear();
      return member;
    }
    found.insert(found.end(), test.features.begin(), test.features.end());
    for (const Feature& f : found) member.features.push_back({f.name + "@" + label, f.value});
    series.push_back({task.cell_pressure_Pa, found[1].value, found[0].value});
    member.curves.push_back(std::move(test.curves.front()));
  }
  add_series_features(series, member.features);
  return member;
}

std::vector<ExperimentResult> all_failed(std::size_t num_members, const DensestStates& densest) {
  ExperimentResult failed;
  failed.status = densest.status;
  failed.message = densest.message;
  return std::vector<ExperimentResult>(num_members, failed);
}

}  // namespace

std::string triaxial_state_label(double cell_pressure_Pa, std::optional<double> relative_density) {
  if (!relative_density) return fmt::format("{:.0f}", cell_pressure_Pa);
  return fmt::format("{:.0f},{:.3f}", cell_pressure_Pa, *relative_density);
}

std::vector<Field> fields(DrainedTriaxialConfig& c) {
  return {{"side_m", &c.side_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"cell_pressure_Pa", &c.cell_pressure_Pa, 100, 1e8},
          {"relative_density", &c.relative_density, 0, 1},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, -1, 1},
          {"inertial_number", &c.inertial_number, 1e-5, 0.1},
          {"max_axial_strain", &c.max_axial_strain, 0.04, 0.5},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

std::vector<std::string> problems(const DrainedTriaxialConfig& c) {
  std::vector<std::string> found;
  if (c.cell_pressure_Pa.empty()) found.push_back("cell_pressure_Pa: needs at least one number");
  if (is_prepared(c) && c.relative_density.size() != c.cell_pressure_Pa.size())
    found.push_back(fmt::format("relative_density has {} numbers and cell_pressure_Pa {}: must be as "
                                "many, or relative_density none",
                                c.relative_density.size(), c.cell_pressure_Pa.size()));
  return found;
}

std::vector<ExperimentResult> run_drained_triaxial(std::span<const SoilMaterial> members,
                                                   const DrainedTriaxialConfig& config,
                                                   PackingStore& packings,
                                                   const RunOptions& options) {
  const PackingSpec spec = packing_spec(config);
  const auto packing = packings.get(spec);
  DensestStates densest;
  if (is_prepared(config)) {
    densest = densest_states(packings, spec, options);
    if (densest.status != RunStatus::completed) return all_failed(members.size(), densest);
  }
  std::vector<TriaxialTask> tasks;
  for (const SoilMaterial& m : members)
    for (std::size_t s = 0; s < config.cell_pressure_Pa.size(); ++s) {
      tasks.push_back({m, config.cell_pressure_Pa[s], std::nullopt});
      if (is_prepared(config)) tasks.back().relative_density = config.relative_density[s];
    }
  // A pack ends with its slowest lane: tests that take like numbers of steps go together.
  std::vector<std::size_t> order(tasks.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::greater(), [&tasks](std::size_t k) {
    return tasks[k].material.contact_modulus_Pa / tasks[k].cell_pressure_Pa;
  });
  std::vector<double> density;
  for (const std::size_t k : order) density.push_back(tasks[k].material.density_kg_per_m3);
  std::vector<ExperimentResult> sorted =
      run_in_packs(density, options, [&](std::span<const std::size_t> task_of_lane) {
        std::vector<TriaxialTask> lanes;
        for (const std::size_t task : task_of_lane) lanes.push_back(tasks[order[task]]);
        return run_pack(lanes, config, *packing, densest, options);
      });
  std::vector<ExperimentResult> tests(tasks.size());
  for (std::size_t k = 0; k < order.size(); ++k) tests[order[k]] = std::move(sorted[k]);
  std::vector<ExperimentResult> results;
  const std::size_t per_member = config.cell_pressure_Pa.size();
  for (std::size_t first = 0; first < tests.size(); first += per_member)
    results.push_back(join(std::span(tasks).subspan(first, per_member),
                           std::span(tests).subspan(first, per_member)));
  return results;
}

}  // namespace tilth
