// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a virtual test costs: core-seconds per member at `search` size in packs of 1, 4 and 8 lanes, as a
// Markdown table. From the repository's root, alone on the machine:
//
//     build/release/bin/laboratory_cost                  # every virtual test
//     build/release/bin/laboratory_cost direct_shear ... # some of them
//     build/release/bin/laboratory_cost --csv [test ...] # data/test_costs.csv: every fidelity, widest pack
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "calibrate/cli/virtual_test.hpp"
#include "dem_core/step.hpp"

namespace {

using namespace tilth;

/// Soils as a fit sees them around its best point: moduli, strengths and friction up to 15 % apart.
/// Triaxial specimens as the Karlsruhe sand asks for them: unbonded, stiff, prepared to a relative density.
std::vector<SoilMaterial> members(int num_members, const TestConfig& config) {
  const bool is_sand = std::holds_alternative<DrainedTriaxialConfig>(config);
  std::vector<SoilMaterial> soils;
  for (int k = 0; k < num_members; ++k) {
    const auto around_one = [k](int stride) { return 0.85 + 0.3 * (stride * k % 8) / 7.0; };
    SoilMaterial m;
    if (is_sand) {
      m.contact_modulus_Pa = 1.5e8;
      m.bond.modulus_Pa = 0.0;
      m.local_damping = 0.2;
    }
    m.contact_modulus_Pa *= around_one(1);
    m.bond.modulus_Pa *= around_one(1);
    m.bond.tensile_strength_Pa *= around_one(3);
    m.bond.cohesion_Pa *= around_one(3);
    m.friction *= around_one(5);
    soils.push_back(m);
  }
  return soils;
}

TestConfig test_of(const std::string& id, Fidelity fidelity) {
  TestConfig config = virtual_test(id, fidelity);
  if (auto* triaxial = std::get_if<DrainedTriaxialConfig>(&config)) {
    triaxial->cell_pressure_Pa = {1e5};
    triaxial->relative_density = {0.6};
  }
  return config;
}

/// Core-seconds per member, "-" without such lanes; how a member failed, to standard error, and "failed".
std::string cost(const TestConfig& config, int num_lanes, PackingStore& packings) {
  if (!lanes_supported(num_lanes)) return "-";
  const std::vector<SoilMaterial> soils = members(num_lanes, config);
  RunOptions options;
  options.max_lanes = num_lanes;
  const std::clock_t start = std::clock();
  const std::vector<ExperimentResult> results =
      run_virtual_test(config, soils, packings, options);
  const double cpu_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  for (const ExperimentResult& r : results)
    if (r.status != RunStatus::completed) {
      fmt::print(stderr, "{} with {} lanes: {}: {}\n", test_id(config), num_lanes, name_of(r.status), r.message);
      return "failed";
    }
  return fmt::format("{:.2f}", cpu_s / num_lanes);
}

void print_csv(const std::vector<std::string>& ids, PackingStore& packings) {
  fmt::print("experiment,fidelity,core_s,provenance,source\n");
  for (const std::string& id : ids)
    for (const auto& [fidelity, name] : {std::pair{Fidelity::preview, "preview"},
                                         std::pair{Fidelity::search, "search"},
                                         std::pair{Fidelity::confirm, "confirm"}}) {
      const TestConfig config = test_of(id, fidelity);
      cost(config, 1, packings);  // makes the packing
      const std::string core_s = cost(config, widest_lanes(), packings);
      if (core_s == "failed") continue;  // no number, no row
      fmt::print("{},{},{},measured,bench/laboratory_cost --csv; nominal soils 15 % apart in packs of {}\n",
                 id, name, core_s, widest_lanes());
      std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
  const bool csv = argc > 1 && std::string(argv[1]) == "--csv";
  const int first = csv ? 2 : 1;
  const std::vector<std::string> ids =
      argc > first ? std::vector<std::string>(argv + first, argv + argc) : virtual_test_ids();
  PackingStore packings(default_packing_folder());
  if (csv) {
    print_csv(ids, packings);
    return 0;
  }
  fmt::print("| virtual test | particles | W = 1 [s] | W = 4 [s] | W = 8 [s] |\n"
             "| --- | ---: | ---: | ---: | ---: |\n");
  for (const std::string& id : ids) {
    TestConfig config = test_of(id, Fidelity::search);
    const std::vector<Field> settings = fields(config);
    const Field* size = find_field(settings, "num_particles");
    cost(config, 1, packings);  // makes the packing, so that no row pays for it
    fmt::print("| `{}` | {} |", id, size ? field_text(*size) : "-");
    for (const int lanes : {1, 4, 8}) {
      fmt::print(" {} |", cost(config, lanes, packings));
      std::fflush(stdout);
    }
    fmt::print("\n");
  }
}
