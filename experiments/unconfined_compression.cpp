// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/unconfined_compression.hpp"

#include <algorithm>

#include "experiments/curve_features.hpp"
#include "experiments/platens.hpp"

namespace tilth {
namespace {

void read_features(ExperimentResult& result, double num_bonds) {
  const Curve& curve = result.curves.front();
  const std::size_t peak = row_of_largest(curve, 1);
  result.features = {
      {"peak_stress_Pa", curve.rows[peak][1]},
      {"strain_at_peak", curve.rows[peak][0]},
      {"secant_modulus_Pa", secant_at_share(curve, 0, 1, peak, 0.5)},
      {"bonds_broken_at_peak", num_bonds > 0 ? curve.rows[peak][2] / num_bonds : 0.0}};
}

/// Lanes at their share of the configured platen speed: 1 or fast_rate_ratio.
std::vector<ExperimentResult> run_pack(std::span<const SoilMaterial> lanes,
                                       std::span<const double> rate_ratio,
                                       const UnconfinedCompressionConfig& config,
                                       const Packing& packing, const RunOptions& options) {
  // 1. bond the packing between the platens
  LaneRun run(make_specimen(packing, lanes, platens(config.specimen_height_m),
                            {config.bond_gap_over_radius}));
  AxialLoading loading{.radius_m = config.specimen_radius_m,
                       .height_m = config.specimen_height_m,
                       .max_axial_strain = config.max_axial_strain,
                       .stop_at_peak_share = config.stop_at_peak_share};
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    loading.speed_m_per_s.push_back(config.platen_speed_over_wave_speed *
                                    wave_speed_m_per_s(lanes[k]) * rate_ratio[k]);
    // The slow test stands for the laboratory's rate; the fast one beside it is faster than that.
    set_nominal_rate(run.specimen.model, static_cast<int>(k),
                     loading.speed_m_per_s[k] / rate_ratio[k] / config.specimen_height_m);
    run.results[k].curves = {{rate_ratio[k] == 1 ? "stress_strain" : "stress_strain_fast",
                              {"axial_strain", "axial_stress_Pa", "bonds_broken"},
                              {}}};
  }

  // 2. close the platens until the stress has fallen or the strain is reached
  run_past_peak(run, loading, options);

  // 3. read the curve
  for (std::size_t k = 0; k < run.results.size(); ++k) {
    ExperimentResult& r = run.results[k];
    if (r.status != RunStatus::completed) continue;
    read_features(r, static_cast<double>(run.specimen.model.bonds.size()));
    r.inertial_number = axial_inertial_number(
        loading.speed_m_per_s[k], config.specimen_height_m, packing.mean_radius_m,
        lanes[k].density_kg_per_m3, std::max(r.feature("peak_stress_Pa"), 1e-9));
  }
  return run.results;
}

/// The slow run is the result; a fast one beside it adds its curve and the ratio of the peaks.
ExperimentResult join(std::span<ExperimentResult> runs) {
  if (runs.size() == 1) return std::move(runs.front());
  ExperimentResult member = joined_status(
      runs, [](std::size_t k) { return k == 0 ? "" : "at the fast rate: "; }, runs[0].message);
  member.inertial_number = runs[0].inertial_number;
  if (member.status == RunStatus::completed) {
    member.features = runs[0].features;
    member.features.push_back({"fast_peak_ratio", runs[1].feature("peak_stress_Pa") /
                                                      runs[0].feature("peak_stress_Pa")});
  }
  for (ExperimentResult& r : runs) member.curves.push_back(std::move(r.curves.front()));
  return member;
}

}  // namespace

std::vector<Field> fields(UnconfinedCompressionConfig& c) {
  return {{"specimen_radius_m", &c.specimen_radius_m, 1e-3, 10},
          {"specimen_height_m", &c.specimen_height_m, 1e-3, 10},
          {"num_particles", &c.num_particles, 50, 200000},
          {"porosity", &c.porosity, 0.34, 0.6},
          {"size_spread", &c.size_spread, 0, 0.6},
          {"bond_gap_over_radius", &c.bond_gap_over_radius, 0, 1},
          {"platen_speed_over_wave_speed", &c.platen_speed_over_wave_speed, 1e-6, 1e-2},
          {"max_axial_strain", &c.max_axial_strain, 1e-3, 0.5},
          {"stop_at_peak_share", &c.stop_at_peak_share, 0, 0.99},
          {"fast_rate_ratio", &c.fast_rate_ratio, 1, 1000},
          {"packing_seed", &c.packing_seed, 0, 9e15}};
}

PackingSpec packing_spec(const UnconfinedCompressionConfig& c) {
  return cylinder_packing(c.specimen_radius_m, c.specimen_height_m, c.num_particles, c.porosity,
                          c.size_spread, c.packing_seed);
}

std::vector<ExperimentResult> run_unconfined_compression(std::span<const SoilMaterial> members,
                                                         const UnconfinedCompressionConfig& config,
                                                         PackingStore& packings,
                                                         const RunOptions& options) {
  const auto packing = packings.get(packing_spec(config));
  std::vector<double> rate_ratios = {1.0};
  if (config.fast_rate_ratio > 1) rate_ratios.push_back(config.fast_rate_ratio);
  return run_settings(
      members, rate_ratios, options,
      [&](std::span<const SoilMaterial> lanes, std::span<const double> rate_ratio) {
        return run_pack(lanes, rate_ratio, config, *packing, options);
      },
      join);
}

}  // namespace tilth
