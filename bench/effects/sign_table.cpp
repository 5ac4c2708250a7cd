// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What every effect of the catalogue does to every statistic at its typical size: mean log change over
// packings, base and changed soil on the same packing, beside the directions expected beforehand.
// sign_table OUT.csv [directions.csv] [num_packings] [test ...]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <thread>

#include "calibrate/cli/virtual_test.hpp"
#include "calibrate/effect_catalogue.hpp"
#include "calibrate/parallel.hpp"

using namespace tilth;

namespace {

struct Statistic {
  std::string column;  ///< of the table of directions
  std::string test;
  std::function<double(const ExperimentResult&)> value;
};

auto feature(const char* name) {
  return [name](const ExperimentResult& r) { return r.feature(name); };
}

std::size_t column_of(const Curve& c, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(c.columns, name) - c.columns.begin());
}

/// Relative fall of the stress over relative strain beyond the peak.
double brittleness(const ExperimentResult& r) {
  const auto& rows = r.curves.front().rows;
  const auto peak = std::ranges::max_element(rows, {}, [](const auto& row) { return row[1]; });
  const auto& last = rows.back();
  return (1 - last[1] / (*peak)[1]) / (last[0] / (*peak)[0] - 1);
}

/// Strain at which the first loading reaches a stress.
std::function<double(const ExperimentResult&)> strain_at(double stress_Pa) {
  return [stress_Pa](const ExperimentResult& r) {
    for (const auto& row : r.curves.front().rows)
      if (row[1] >= stress_Pa) return row[0];
    return std::nan("");
  };
}

/// Largest rise of the shear box's lid at the first normal stress, over the height of a fine reading.
double rise(const ExperimentResult& r) {
  const Curve& c = r.curves.front();
  const std::size_t k = column_of(c, "vertical_displacement_m");
  double most = 1e-6;
  for (const auto& row : c.rows) most = std::max(most, row[k]);
  return most;
}

double shallow_cone(const ExperimentResult& r) {
  double sum = 0, n = 0;
  for (const auto& row : r.curves.front().rows)
    if (row[0] > 0 && row[0] < 0.02) sum += row[2], ++n;
  return sum / n;
}

std::vector<Statistic> statistics() {
  return {{"ucs_modulus", "unconfined_compression", feature("secant_modulus_Pa")},
          {"ucs_peak", "unconfined_compression", feature("peak_stress_Pa")},
          {"ucs_strain_at_peak", "unconfined_compression", feature("strain_at_peak")},
          {"ucs_drop", "unconfined_compression", brittleness},
          {"ucs_fast_peak", "unconfined_compression",
           [](const ExperimentResult& r) {
             return r.feature("fast_peak_ratio") * r.feature("peak_stress_Pa");
           }},
          {"bt_strength", "direct_tension", feature("tensile_strength_Pa")},
          {"ds_peak_10kPa", "direct_shear", feature("peak_shear_stress_Pa@10000")},
          {"ds_peak_100kPa", "direct_shear", feature("peak_shear_stress_Pa@100000")},
          {"ds_residual_10kPa", "direct_shear", feature("residual_shear_stress_Pa@10000")},
          {"ds_residual_100kPa", "direct_shear", feature("residual_shear_stress_Pa@100000")},
          {"ds_dilation", "direct_shear", rise},
          {"oed_strain_25kPa", "confined_compression", strain_at(25e3)},
          {"oed_strain_200kPa", "confined_compression", strain_at(199e3)},
          {"oed_unload_ratio", "confined_compression",
           [](const ExperimentResult& r) {
             return r.feature("unload_modulus_Pa") / r.feature("constrained_modulus_Pa");
           }},
          {"steel_shear", "interface_shear", feature("residual_interface_stress_Pa@10000")},
          {"cpt_5cm", "cone_penetration", shallow_cone},
          {"cpt_20cm", "cone_penetration", feature("cone_resistance_Pa")},
          {"extra_cone_pull_out", "cone_penetration", feature("pull_out_force_N")},
          {"aor_angle", "angle_of_repose", feature("repose_angle_rad")},
          {"dr_draught", "sweep_tillage", feature("draught_N")},
          {"dr_vertical", "sweep_tillage", feature("vertical_force_N")},
          {"tr_displacement", "sweep_tillage", feature("forward_displacement_m@0.050m")}};
}

TestConfig small(const std::string& id, std::uint64_t seed) {
  TestConfig test = virtual_test(id, Fidelity::preview);
  const std::vector<Field> settings = fields(test);
  const auto set = [&](const char* name, std::vector<double> values) {
    if (const Field* f = find_field(settings, name)) set_numbers(*f, values);
  };
  set("num_particles", {id == "cone_penetration" ? 500.0 : 300.0});
  set("fast_rate_ratio", {30});
  if (id == "direct_shear" || id == "interface_shear") set("normal_stress_Pa", {10e3, 100e3});
  set("load_to_stress_Pa", {200e3});
  set_packing_seed(test, seed);
  return test;
}

SoilMaterial soil() {
  SoilMaterial m;
  m.contact_modulus_Pa = m.bond.modulus_Pa = 3e6;
  m.bond.tensile_strength_Pa = 4e3;
  m.bond.cohesion_Pa = 6e3;
  m.bond.friction_angle_rad = 0.5236;
  return m;
}

struct Change {
  std::string name;  ///< id, or id.parameter where an effect has several
  const Effect* effect;
  SoilMaterial material;
};

std::vector<Change> changes() {
  std::vector<Change> all;
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters) {
      if (p.side == EffectSide::nuisance) continue;
      Change c{e.id + (&p == &e.parameters.front() ? "" : "." + p.name), &e, soil()};
      const std::vector<Field> names = fields(c.material);
      set_numbers(*find_field(names, p.name), {p.typical});
      all.push_back(std::move(c));
    }
  return all;
}

/// Levels -3..3 by effect id and column; a row of another name for what one effect's second parameter does.
using Directions = std::map<std::string, std::map<std::string, int>>;

Directions read_directions(const std::string& file) {
  Directions found;
  std::ifstream in(file);
  std::vector<std::string> columns;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    if (columns.empty()) {
      columns = cells;
      continue;
    }
    for (std::size_t k = 4; k < std::min(cells.size(), columns.size()); ++k)
      found[cells[0]][columns[k]] = std::atoi(cells[k].c_str());
  }
  return found;
}

/// Names of rows in the table of directions, and the sense in which typical sizes go against them.
std::pair<std::string, int> row_of(const Change& c) {
  if (c.name == "bond_envelope") return {"bond_tension_cutoff", 1};
  if (c.name == "bond_envelope.bond_friction_angle_offset_rad") return {"bond_envelope", 1};
  if (c.name == "particle_size") return {"particle_size", -1};  // the row speaks of coarser grains
  return {c.name, 1};
}

struct Sample {
  double mean = 0, error = 0;
  std::size_t n = 0;
};

Sample sample(const std::vector<double>& x) {
  Sample s;
  s.n = x.size();
  for (const double v : x) s.mean += v / static_cast<double>(s.n);
  double squares = 0;
  for (const double v : x) squares += (v - s.mean) * (v - s.mean);
  s.error = s.n > 1 ? std::sqrt(squares / static_cast<double>((s.n - 1) * s.n)) : std::nan("");
  return s;
}

const char* verdict(const Sample& s, int expected) {
  const bool seen = std::abs(s.mean) > std::max(0.03, 2 * s.error);
  const int sign = s.mean > 0 ? 1 : -1;
  if (expected == 0) return seen && std::abs(s.mean) > 0.1 ? "unexpected" : "as expected";
  if (seen && sign * expected < 0) return "CONTRADICTS";
  return seen ? "as expected" : "not seen";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fputs("sign_table OUT.csv [directions.csv] [packings] [test ...]\n", stderr), 2;
  const Directions directions = read_directions(argc > 2 ? argv[2] : TILTH_SOURCE_DIR "/data/effect_directions.csv");
  const std::uint64_t num_packings = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 8;
  const std::vector<std::string> wanted(argv + std::min(argc, 4), argv + argc);
  std::FILE* out = std::fopen(argv[1], "w");
  fmt::print(out, "effect,statistic,log_change,standard_error,packings,expected,verdict\n");
  PackingStore packings;
  RunOptions options;
  options.for_each = [](std::size_t n, const auto& body) { parallel_for_each_index(n, 2, body); };
  for (const std::string& test : virtual_test_ids()) {
    if (!wanted.empty() && std::ranges::find(wanted, test) == wanted.end()) continue;
    std::vector<Statistic> own;
    for (const Statistic& s : statistics())
      if (s.test == test) own.push_back(s);
    if (own.empty()) continue;
    std::vector<Change> active;
    std::vector<SoilMaterial> members = {soil()};
    for (const Change& c : changes())
      if (std::ranges::find(c.effect->tests, test) != c.effect->tests.end()) {
        active.push_back(c);
        members.push_back(c.material);
      }
    std::map<std::string, std::map<std::string, std::vector<double>>> logs;
    for (std::uint64_t seed = 1; seed <= num_packings; ++seed) {
      const auto results = run_virtual_test(small(test, seed), members, packings, options);
      for (std::size_t k = 0; k < active.size(); ++k)
        for (const Statistic& s : own) {
          if (results[0].status != RunStatus::completed || results[k + 1].status != RunStatus::completed) continue;
          const double change = std::log(s.value(results[k + 1]) / s.value(results[0]));
          if (std::isfinite(change)) logs[active[k].name][s.column].push_back(change);
        }
      for (std::size_t k = 0; k < members.size(); ++k)
        if (results[k].status != RunStatus::completed)
          fmt::print(stderr, "{} packing {} {}: {}\n", test, seed, k ? active[k - 1].name : "base", results[k].message);
    }
    for (const Change& c : active)
      for (const Statistic& s : own) {
        const Sample found = sample(logs[c.name][s.column]);
        const auto [row, sense] = row_of(c);
        const auto known = directions.find(row);
        const bool has = known != directions.end() && known->second.contains(s.column);
        const int expected = has ? sense * known->second.at(s.column) : 0;
        fmt::print(out, "{},{},{:.4f},{:.4f},{},{},{}\n", c.name, s.column, found.mean, found.error,
                   found.n, has ? std::to_string(expected) : "", has ? verdict(found, expected) : "");
      }
    std::fflush(out);
    fmt::print(stderr, "{} done\n", test);
  }
  std::fclose(out);
}
