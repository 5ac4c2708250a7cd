// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/figures.hpp"
#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/fit_output.hpp"
#include "calibrate/cli/interrupt.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/cli/sweep_simulation.hpp"
#include "calibrate/cli/test_settings.hpp"
#include "calibrate/draught_band.hpp"
#include "calibrate/parallel.hpp"
#include "dem_core/stl.hpp"

namespace tilth {
namespace {

/// --vtk and --tool, which only a sweep has.
void apply_tool(const SimulateOptions& o, TestConfig& config, std::vector<std::string>& problems) {
  auto* sweep = std::get_if<SweepTillageConfig>(&config);
  if (!sweep && (o.vtk || !o.tool.empty()))
    problems.push_back(fmt::format("--vtk and --tool need --experiment sweep_tillage, not {}",
                                   o.experiment));
  if (!sweep || o.tool.empty()) return;
  std::vector<std::string> repairs;
  try {
    sweep->tool_mesh = read_stl(o.tool, o.tool_metres_per_unit, &repairs);
  } catch (const std::runtime_error& e) {
    problems.push_back(fmt::format("--tool {}", e.what()));
  }
  for (const std::string& repair : repairs) std::cerr << o.tool << ": " << repair << '\n';
}

void draw(const std::string& id, const std::vector<std::uint64_t>& seeds,
          const std::vector<ExperimentResult>& results, const std::filesystem::path& folder) {
  const CurveStyle style = curve_style(id);
  for (const Curve& first : results.front().curves) {
    CurveFigure figure{fmt::format("{}, {}", id, first.name), style.x_label, style.y_label,
                       style.x_column, style.y_column, style.x_scale, style.y_scale, true, {}, {}};
    for (std::size_t k = 0; k < results.size(); ++k)
      for (const Curve& c : results[k].curves)
        if (c.name == first.name)
          figure.series.push_back({fmt::format("packing {}", seeds[k]), static_cast<int>(k), c});
    const std::string why =
        draw_curves(figure, folder / "figures" / fmt::format("{}_{}.svg", id, first.name));
    if (!why.empty()) std::cerr << "no figure: " << why << '\n';
  }
}

/// The mean draught beside what the field standard expects, where the soil's texture is known.
void say_draught_band(const MaterialSource& source, const SweepTillageConfig& sweep,
                      const std::vector<ExperimentResult>& results) {
  const std::optional<SoilData> soil = soil_of(source);
  if (!soil || !sweep.tool_mesh.triangle.empty()) return;
  const std::optional<TextureClass> texture = texture_class(*soil);
  double sum_N = 0.0, n = 0.0;
  for (const ExperimentResult& r : results)
    if (r.status == RunStatus::completed) sum_N += r.feature("draught_N"), n += 1;
  if (!texture || n == 0) return;
  const DraughtBand band =
      sweep_draught_band(*texture, sweep.sweep.width_m, sweep.tool_depth_m, sweep.speed_m_per_s);
  std::cout << draught_sentence(*texture, band, sum_N / n) << '\n';
}

}  // namespace

void add_simulate_options(CLI::App& command, SimulateOptions& o) {
  command.add_option("--experiment", o.experiment, "name of the virtual test")->required();
  command.add_option("--soil", o.soil, "soil whose nominal parameters are used");
  command.add_option("--data", o.soil_folder, "a folder in the soil format, instead of --soil");
  command.add_option("--fit", o.fit, "fit.json or run folder: use its fitted parameters");
  command.add_option("--set", o.settings, "key=value of the material or the test; may be repeated")
      ->take_all();
  command.add_option("--out", o.out, "output folder (default runs/<experiment>-<n>)");
  command.add_option("--seed", o.seed, "first packing seed (default 1)")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--seeds", o.num_seeds, "number of packings (default 1)")
      ->check(CLI::Range(1, 1000));
  command.add_option("--threads", o.num_threads, "threads (default: all processors)")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--quick", o.quick, "small and fast specimen");
  command.add_flag("--vtk", o.vtk, "sweep_tillage: write a ParaView time series to OUT/vtk");
  command.add_option("--tool", o.tool, "sweep_tillage: STL file of the tool (x forward, z up)");
  command.add_option("--tool-unit-m", o.tool_metres_per_unit, "metres per unit of --tool (0.001)")
      ->check(CLI::PositiveNumber);
}

int run_simulate(const SimulateOptions& o, const std::string& command_line) {
  std::vector<std::string> problems;
  TestConfig config = virtual_test(o.experiment, o.quick ? Fidelity::preview : Fidelity::confirm);
  SoilMaterial material = starting_material({o.soil, o.soil_folder, o.fit}, config, problems);
  apply_settings("--set", o.settings, config, material, problems);
  apply_tool(o, config, problems);
  refuse_bad_test(std::move(problems), config, material);
  const std::filesystem::path folder = make_run_folder(o.out, o.experiment);

  PackingStore packings(default_packing_folder(), solver_version);
  const RunContext context{packings, threads_or_all(o.num_threads), 0, &interrupt_flag()};
  std::vector<std::uint64_t> seeds;
  for (int k = 0; k < o.num_seeds; ++k) seeds.push_back(o.seed + static_cast<std::uint64_t>(k));
  std::vector<TestRun> runs;
  for (const std::uint64_t seed : seeds) {
    runs.push_back({config, "", material});
    set_packing_seed(runs.back().config, seed);
  }
  const auto* sweep = std::get_if<SweepTillageConfig>(&config);
  std::vector<std::string> missing;
  const std::vector<ExperimentResult> results =
      sweep ? simulate_sweeps(*sweep, material, seeds, context, {folder, o.vtk}, missing)
            : run_tests(runs, context);

  write_file(folder / "result.json",
             simulation_json(config, material, seeds, results, command_line));
  bool all_completed = true;
  for (std::size_t k = 0; k < results.size(); ++k) {
    for (const Curve& c : results[k].curves)
      write_file(folder / "curves" / fmt::format("{}_seed{}_{}.csv", o.experiment, seeds[k], c.name),
                 curve_csv(c));
    std::cout << fmt::format("packing {}: {} ({})\n", seeds[k], name_of(results[k].status),
                             results[k].message);
    for (const Feature& f : results[k].features)
      std::cout << fmt::format("  {:<34} {:.6g}\n", f.name, f.value);
    all_completed = all_completed && results[k].status == RunStatus::completed;
  }
  if (!sweep) draw(o.experiment, seeds, results, folder);
  if (sweep) say_draught_band({o.soil, o.soil_folder, o.fit}, *sweep, results);
  for (const std::string& why : missing) std::cerr << "no figure: " << why << '\n';
  std::cout << "results: " << folder.string() << '\n';
  if (interrupt_flag().load()) return exit_budget;
  return all_completed ? exit_done : exit_failed_runs;
}

}  // namespace tilth
