// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/direct_tension.hpp"

#include "experiments/curve_features.hpp"
#include "experiments/platens.hpp"

namespace tilth {
namespace {

void read_features(ExperimentResult& result, double num_bonds) {
  const Curve& curve = result.curves.front();
  const std::size_t peak = row_of_largest(curve, 1);
  if (!(curve.rows[peak][1] > 0)) {
    result.status = RunStatus::not_settled;
    result.message = "carried no tension: is anything bonded?";
    return;
  }
  result.features = {{"tensile_strength_Pa", curve.rows[peak][1]},
                     {"strain_at_peak", curve.rows[peak][0]},
                     {"tensile_modulus_Pa", secant_at_share(curve, 0, 1, peak, 0.5)},
                     {"bonds_broken_at_peak", num_bonds > 0 ? curve.rows[peak][2] / num_bonds : 0.0}};
}

std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       const DirectTensionConfig& config, const Packing& packing,
                                       const RunOptions& options) {
  LaneRun run(make_specimen(packing, lanes, platens(config.specimen_height_m),
                            {config.bond_gap_over_radius, {bottom_platen, top_platen}}));
  AxialLoading loading{.radius_m = config.specimen_radius_m,
                       .height_m = config.specimen_height_m,
                       .sense = -1,
                       .max_axial_strain = config.max_axial_strain,
                       .stop_at_peak_share = config.stop_at_peak_share};
  for (const SoilMaterial& m : lanes)
    loading.speed_m_per_s.push_back(config.pull_speed_over_wave_speed * wave_speed_m_per_s(m));
  for (int lane = 0; lane < run.num_lanes(); ++lane)
    set_nominal_rate(run.specimen.model, lane,
                     loading.speed_m_per_s[static_cast<std::size_t>(lane)] / config.specimen_height_m);
  for (ExperimentResult& r : run.results)
    r.curves = {{"stress_strain", {"axial_strain", "tensile_stress_Pa", "bonds_broken"}, {}}};
  run_past_peak(run, loading, options);
  for (std::size_t k = 0; k < run.results.size(); ++k) {
    ExperimentResult& r = run.results[k];
    if (r.status == RunStatus::completed)
      read_features(r, static_cast<double>(run.specimen.model.bonds.size()));
    if (r.status == RunStatus::completed)
      r.inertial_number = axial_inertial_number(
          loading.speed_m_per_s[k], config.specimen_height_m, packing.mean_radius_m,
          lanes[k].density_kg_per_m3, r.feature("tensile_strength_Pa"));
  }
  return run.results;
}

}  // namespace

std::vector<Field> fields(DirectTensionConfig& c) {
  return {{"specimen_radius_m", &c.specimen_radius_m, 1e-3, 10},
          {"specimen_height_m", &c.specimen_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, 0, 1},
          {"pull_speed_over_wave_speed", &c.pull_speed_over_wave_speed, 1e-6, 1e-2},
          {"max_axial_strain", &c.max_axial_strain, 1e-3, 0.5},
          {"stop_at_peak_share", &c.stop_at_peak_share, 0, 0.99},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

PackingSpec packing_spec(const DirectTensionConfig& c) {
  return cylinder_packing(c.specimen_radius_m, c.specimen_height_m, c.num_particles, c.porosity,
                          c.size_spread, c.packing_seed);
}

std::vector<ExperimentResult> run_direct_tension(std::span<const SoilMaterial> members,
                                                 const DirectTensionConfig& config,
                                                 PackingStore& packings,
                                                 const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  return run_members(members, options, [&](std::span<const SoilMaterial> lanes) {
    return run_pack(lanes, config, *packing, options);
  });
}

}  // namespace tilth
