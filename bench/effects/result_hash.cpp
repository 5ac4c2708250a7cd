// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// One hash per virtual test, of every bit of its results: equal before and after a change that should
// move nothing. result_hash [name=value ...] sets numbers of the material, in every second member.
#include <bit>
#include <chrono>
#include <cstdio>
#include <string>

#include "calibrate/cli/virtual_test.hpp"

using namespace tilth;

namespace {

class Hash {  // FNV-1a over 64-bit words
 public:
  void add(double x) { add_word(std::bit_cast<std::uint64_t>(x)); }
  void add_word(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3ULL; }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Five loamy soils of unlike strength, so that every test runs in a pack with spare lanes.
std::vector<SoilMaterial> soils(int argc, char** argv) {
  std::vector<SoilMaterial> all;
  for (int k = 0; k < 5; ++k) {
    SoilMaterial m;
    m.contact_modulus_Pa = m.bond.modulus_Pa = 2e6 * (1 + 0.3 * k);
    m.bond.tensile_strength_Pa = 4e3 * (1 + 0.5 * k);
    m.bond.cohesion_Pa = 1.5 * m.bond.tensile_strength_Pa;
    m.bond.friction_angle_rad = 0.5;
    m.wall_friction = 0.1;
    m.rolling_friction = k == 3 ? 0.2 : 0.0;
    for (int a = 1; a < argc && k % 2 == 1; ++a) {
      const std::string text = argv[a];
      const std::size_t equals = text.find('=');
      const std::vector<Field> names = fields(m);
      const Field* field = find_field(names, text.substr(0, equals));
      if (!field) std::fprintf(stderr, "no number %s\n", text.c_str());
      else set_field(*field, std::string_view(text).substr(equals + 1));
    }
    all.push_back(m);
  }
  return all;
}

TestConfig small(const std::string& id) {
  TestConfig test = virtual_test(id, Fidelity::preview);
  std::vector<Field> settings = fields(test);
  if (const Field* n = find_field(settings, "num_particles")) set_numbers(*n, {150});
  if (const Field* r = find_field(settings, "fast_rate_ratio")) set_numbers(*r, {4});
  if (const Field* r = find_field(settings, "speed_m_per_s")) set_numbers(*r, {0.4});
  if (id == "sweep_tillage") {
    set_numbers(*find_field(settings, "particle_radius_m"), {0.035});
    set_numbers(*find_field(settings, "speed_m_per_s"), {1.5});
  }
  if (id == "vane_shear") set_numbers(*find_field(settings, "max_rotation_rad"), {0.15});
  return test;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<SoilMaterial> members = soils(argc, argv);
  PackingStore packings;
  for (const std::string& id : virtual_test_ids()) {
    const auto start = std::chrono::steady_clock::now();
    Hash hash;
    int completed = 0;
    for (const ExperimentResult& r : run_virtual_test(small(id), members, packings, {})) {
      hash.add(r.dt_s);
      hash.add_word(static_cast<std::uint64_t>(r.num_steps));
      completed += r.status == RunStatus::completed;
      for (const Curve& c : r.curves)
        for (const auto& row : c.rows)
          for (const double x : row) hash.add(x);
      for (const Feature& f : r.features) hash.add(f.value);
    }
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%-24s %016llx  %d of %zu completed, %.2f s\n", id.c_str(),
                static_cast<unsigned long long>(hash.value()), completed, members.size(), seconds);
    std::fflush(stdout);
  }
}
