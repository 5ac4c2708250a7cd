// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/sweep_simulation.hpp"

#include <fmt/format.h>

#include <optional>

#include "calibrate/cli/sweep_views.hpp"
#include "calibrate/cli/virtual_test.hpp"
#include "calibrate/parallel.hpp"
#include "experiments/measurement_effects.hpp"

namespace tilth {
namespace {

struct WatchedRun {
  ExperimentResult result;
  BedView settled, stopped, at_rest;
};

WatchedRun watch(const SoilMaterial& material, const SweepTillageConfig& config,
                 const RunContext& context, const SweepOutput& output, std::size_t num_runs) {
  WatchedRun run;
  std::optional<SweepVtk> vtk;
  if (output.vtk) vtk.emplace(output.folder / "vtk" / fmt::format("seed{}", config.packing_seed));
  const SweepObserver observer{output.vtk_interval_m, [&](const SweepFrame& frame) {
                                 if (vtk) vtk->add(frame);
                                 if (frame.moment == SweepMoment::settled)
                                   run.settled = view_of(frame);
                                 if (frame.moment == SweepMoment::stopped)
                                   run.stopped = view_of(frame);
                                 if (frame.moment == SweepMoment::at_rest)
                                   run.at_rest = view_of(frame);
                               }};
  run.result =
      watch_sweep_tillage(material, config, context.packings, observer, run_options(context, num_runs));
  return run;
}

void draw(const WatchedRun& run, std::uint64_t seed, const std::filesystem::path& folder,
          std::vector<std::string>& missing) {
  const std::string title = fmt::format("sweep_tillage, packing {}", seed);
  const auto file = [&](const char* what) {
    return folder / "figures" / fmt::format("sweep_tillage_seed{}_{}.svg", seed, what);
  };
  std::vector<std::string> reasons = {draw_sweep_forces(title, run.result, file("forces")),
                                      draw_sweep_section(title, run.result, file("section"))};
  reasons.push_back(run.at_rest.position_m.empty()
                        ? "the run did not come to rest"
                        : draw_bed(title, run.settled, run.stopped, run.at_rest, file("bed")));
  for (const std::string& why : reasons)
    if (!why.empty()) missing.push_back(fmt::format("packing {}: {}", seed, why));
}

}  // namespace

std::vector<ExperimentResult> simulate_sweeps(const SweepTillageConfig& config,
                                              const SoilMaterial& material,
                                              std::span<const std::uint64_t> seeds,
                                              const RunContext& context, const SweepOutput& output,
                                              std::vector<std::string>& missing) {
  TestConfig set_up = config;
  SoilMaterial on_day = material;
  apply_setup_effects(set_up, on_day);
  std::vector<WatchedRun> runs(seeds.size());
  parallel_for_each_index(seeds.size(), context.num_threads, [&](std::size_t k) {
    SweepTillageConfig own = std::get<SweepTillageConfig>(set_up);
    own.packing_seed = seeds[k];
    runs[k] = watch(on_day, own, context, output, seeds.size());
    apply_measurement_effects("sweep_tillage", fields(own), material.effects, runs[k].result);
  });
  std::vector<ExperimentResult> results;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    draw(runs[k], seeds[k], output.folder, missing);
    results.push_back(std::move(runs[k].result));
  }
  return results;
}

}  // namespace tilth
