// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Speed of the core on the reference cases. items_per_second = particle-steps per CPU second on one
// core, all lanes counted. bench/peers/run puts other codes beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "calibrate/parallel.hpp"
#include "dem_core/packing.hpp"
#include "dem_core/step.hpp"

namespace {

using namespace tilth;

struct Case {
  Model model;
  State state;
};

/// Rows of a table with '#' comments and one header line; gzip or plain.
std::vector<std::vector<double>> read_rows(const std::string& name) {
  const std::string file = std::string(TILTH_SOURCE_DIR) + "/" + name;
  FILE* pipe = ::popen(("gzip -cdf " + file).c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot read " + file);
  std::string text;
  char buffer[65536];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  ::pclose(pipe);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream lines(text);
  std::vector<std::vector<double>> rows;
  bool header_seen = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (!std::exchange(header_seen, true)) continue;
    std::istringstream cells(line);
    std::vector<double>& row = rows.emplace_back();
    for (double v; cells >> v;) row.push_back(v);
  }
  return rows;
}

/// The reference cylinder, past its peak; lane k has strengths up to 30 % apart.
Case bonded_cylinder(int num_lanes) {
  Case c;
  std::vector<Vec3> position;
  for (const auto& r : read_rows("tests/reference/bonded_cylinder/spheres.csv")) {
    position.emplace_back(r[0], r[1], r[2]);
    c.model.radius_m.push_back(r[3]);
  }
  for (const auto& r : read_rows("tests/reference/bonded_cylinder/bonds.csv")) {
    const auto i = static_cast<std::size_t>(r[0]);
    const auto j = static_cast<std::size_t>(r[1]);
    c.model.bonds.push_back(bond_from_numbers(static_cast<int>(i), static_cast<int>(j),
                                              c.model.radius_m[i] + c.model.radius_m[j]));
  }
  c.model.mass_kg = sphere_masses_kg(c.model.radius_m, 1.0);
  c.model.stiffness_kind = StiffnessKind::per_contact;
  c.model.damping_kind = DampingKind::rate;
  c.model.contact_beside_bond = false;
  for (int k = 0; k < num_lanes; ++k) {
    const double strength = num_lanes == 1 ? 1.0 : 0.7 + 0.6 * k / (num_lanes - 1);
    c.model.lanes.push_back({.contact_stiffness = 1e5,
                             .shear_stiffness_ratio = 0.4,
                             .friction = 0.5,
                             .local_damping = 0.3,
                             .bond = {1e5, 4e4, 2.5e4, 2e4, 1000 * strength, 500 * strength, 0.5},
                             .dt_s = 5e-4});
  }
  constexpr double height = 37.252929;
  c.model.walls = {{.direction = Vec3::UnitZ()},
                   {.direction = -Vec3::UnitZ(), .position_m = height * Vec3::UnitZ()}};
  c.state = initial_state(c.model, position);
  for (int k = 0; k < num_lanes; ++k)
    c.state.drive(1, k).velocity_m_per_s = -3e-3 * height * Vec3::UnitZ();
  return c;
}

/// Settled or flowing bed; spheres ordered in space, as LAMMPS orders its own.
Case bed(const std::string& table, double length, double height, const Vec3& gravity,
         int num_lanes) {
  Case c;
  const auto rows = read_rows(table);
  std::vector<Vec3> position;
  for (const auto& r : rows) position.emplace_back(r[0], r[1], r[2]);
  const std::vector<int> order = spatial_order(position, 2.5);
  std::vector<Vec3> sorted;
  for (const int k : order) {
    sorted.push_back(position[static_cast<std::size_t>(k)]);
    c.model.radius_m.push_back(rows[static_cast<std::size_t>(k)][3]);
  }
  c.model.mass_kg = sphere_masses_kg(c.model.radius_m, 1.0);
  c.model.stiffness_kind = StiffnessKind::per_contact;
  c.model.damping_kind = DampingKind::rate;
  c.model.gravity_m_per_s2 = gravity;
  c.model.skin_m = 0.3;
  const LaneLaw law{.contact_stiffness = 2e4,
                    .shear_stiffness_ratio = 0.5,
                    .friction = 0.5,
                    .normal_damping = 40,
                    .tangential_damping = 20,
                    .bond = {},
                    .dt_s = 5e-4};
  c.model.lanes.assign(static_cast<std::size_t>(num_lanes), law);
  const Vec3 size(length, length, height);
  for (int axis = 0; axis < 3; ++axis) {
    c.model.walls.push_back({.direction = Vec3::Unit(axis)});
    c.model.walls.push_back({.direction = -Vec3::Unit(axis), .position_m = size});
  }
  c.state = initial_state(c.model, sorted);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto& r = rows[static_cast<std::size_t>(order[k])];
    if (r.size() < 10) continue;
    c.state.set_velocity_m_per_s(static_cast<int>(k), {r[4], r[5], r[6]});
    c.state.set_angular_velocity_rad_per_s(static_cast<int>(k), {r[7], r[8], r[9]});
  }
  return c;
}

void advance(Case& c, Workspace& workspace, int num_steps) {
  for (int n = 0; n < num_steps; ++n) step(c.model, c.state, workspace);
}

void measure(benchmark::State& bench, const Case& start, int warm_up, int num_steps) {
  for (auto _ : bench) {
    bench.PauseTiming();
    Case c = start;
    Workspace workspace;
    advance(c, workspace, warm_up);
    bench.ResumeTiming();
    advance(c, workspace, num_steps);
  }
  bench.SetItemsProcessed(bench.iterations() * num_steps * start.model.num_particles() *
                          start.model.num_lanes());
}

bool supported(benchmark::State& bench, int num_lanes) {
  if (lanes_supported(num_lanes)) return true;
  bench.SkipWithError("this processor has no instructions for so many lanes");
  return false;
}

void unconfined_compression(benchmark::State& bench) {
  const int lanes = static_cast<int>(bench.range(0));
  if (supported(bench, lanes)) measure(bench, bonded_cylinder(lanes), 0, 12000);
}

void settled_bed(benchmark::State& bench) {
  const int lanes = static_cast<int>(bench.range(0));
  if (supported(bench, lanes))
    measure(bench,
            bed("tests/reference/settled_bed/settled_4k.csv", 32.293201, 64.586402, {0, 0, -1},
                lanes),
            200, 4000);
}

void flowing_bed(benchmark::State& bench) {
  const int lanes = static_cast<int>(bench.range(0));
  if (supported(bench, lanes))
    measure(bench,
            bed("bench/reference/flow_32k.csv.gz", 62.413753, 124.827505, {1.5, 0, -1}, lanes), 50,
            600);
}

/// One run on several threads; items_per_second over wall time shows the gain.
void flowing_bed_on_threads(benchmark::State& bench) {
  const int num_threads = static_cast<int>(bench.range(0));
  const Case start = bed("bench/reference/flow_32k.csv.gz", 62.413753, 124.827505, {1.5, 0, -1}, 1);
  constexpr int num_steps = 300;
  for (auto _ : bench) {
    bench.PauseTiming();
    Case c = start;
    Workspace workspace;
    workspace.num_threads = num_threads;
    if (num_threads > 1) workspace.side_by_side = thread_team(num_threads);
    advance(c, workspace, 50);
    bench.ResumeTiming();
    advance(c, workspace, num_steps);
  }
  bench.SetItemsProcessed(bench.iterations() * num_steps * start.model.num_particles());
}

/// As many independent batches as threads; items_per_second over wall time shows the gain.
void batches_side_by_side(benchmark::State& bench) {
  const auto num_threads = static_cast<std::size_t>(bench.range(0));
  const Case start = bonded_cylinder(widest_lanes());
  constexpr int num_steps = 6000;
  for (auto _ : bench) {
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < num_threads; ++k)
      threads.emplace_back([&start] {
        Case c = start;
        Workspace workspace;
        advance(c, workspace, num_steps);
      });
    for (std::thread& t : threads) t.join();
  }
  bench.SetItemsProcessed(bench.iterations() * static_cast<std::int64_t>(num_threads) * num_steps *
                          start.model.num_particles() * start.model.num_lanes());
}

BENCHMARK(unconfined_compression)->ArgName("W")->Arg(1)->Arg(4)->Arg(8)->Unit(benchmark::kSecond);
BENCHMARK(settled_bed)->ArgName("W")->Arg(1)->Arg(4)->Arg(8)->Unit(benchmark::kSecond);
BENCHMARK(flowing_bed)->ArgName("W")->Arg(1)->Arg(4)->Arg(8)->Unit(benchmark::kSecond);
BENCHMARK(flowing_bed_on_threads)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kSecond);
BENCHMARK(batches_side_by_side)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace

BENCHMARK_MAIN();
