// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Packings kept in memory and on disk.
#include "dem_core/packing_store.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

using namespace tilth;

namespace {

struct TemporaryFolder {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               ("tilth_packing_store_" + std::to_string(::getpid()));
  TemporaryFolder() { std::filesystem::create_directories(path); }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

PackingSpec tiny() {
  PackingSpec spec;
  spec.num_particles = 40;
  spec.porosity = 0.6;
  return spec;
}

bool same_bits(const Packing& a, const Packing& b) {
  return a.radius_m == b.radius_m && a.position_m == b.position_m &&
         a.mean_radius_m == b.mean_radius_m && a.largest_overlap == b.largest_overlap;
}

std::filesystem::path only_file(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry);
  REQUIRE(files.size() == 1);
  return files[0];
}

std::string read_all(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("packing store: a packing comes back from disk in every bit", "[dem_core][packing]") {
  const TemporaryFolder folder;
  const Packing made = make_packing(tiny());
  CHECK(same_bits(*PackingStore(folder.path).get(tiny()), made));
  const auto stored = read_packing(only_file(folder.path), packing_key(tiny()));
  REQUIRE(stored);
  CHECK(same_bits(*stored, made));
}

TEST_CASE("packing store: a packing is made once per store", "[dem_core][packing]") {
  PackingStore store;
  const auto first = store.get(tiny());
  CHECK(store.get(tiny()) == first);
  PackingSpec other = tiny();
  other.seed = 2;
  CHECK(store.get(other) != first);
}

TEST_CASE("packing store: whatever influences a packing is in its key", "[dem_core][packing]") {
  const std::string key = packing_key(tiny());
  CHECK(packing_key(tiny()) == key);
  const auto changed = [&](auto change) {
    PackingSpec spec = tiny();
    change(spec);
    return packing_key(spec) != key;
  };
  CHECK(changed([](PackingSpec& s) { s.shape = ContainerShape::box; }));
  CHECK(changed([](PackingSpec& s) { s.radius_m *= 1 + 1e-15; }));
  CHECK(changed([](PackingSpec& s) { s.size_m.z() *= 1 + 1e-15; }));
  CHECK(changed([](PackingSpec& s) { s.num_particles += 1; }));
  CHECK(changed([](PackingSpec& s) { s.porosity += 1e-15; }));
  CHECK(changed([](PackingSpec& s) { s.size_spread += 1e-15; }));
  CHECK(changed([](PackingSpec& s) { s.seed += 1; }));
  CHECK_FALSE(changed([](PackingSpec& s) { s.size_m.x() *= 2; }));  // a cylinder has no x size
}

TEST_CASE("packing store: a damaged or foreign file is ignored and replaced",
          "[dem_core][packing]") {
  const TemporaryFolder folder;
  const Packing made = make_packing(tiny());
  PackingStore(folder.path).get(tiny());
  const std::filesystem::path file = only_file(folder.path);
  const std::string good = read_all(file);
  const std::string key = packing_key(tiny());
  for (const std::string& bad :
       {std::string(), good.substr(0, good.size() / 2), good.substr(0, good.size() - 4),
        "another " + good, key + "\n40 x\n", std::string("\xff\xfe binary")}) {
    std::ofstream(file) << bad;
    CHECK(read_packing(file, key) == nullptr);
    CHECK(same_bits(*PackingStore(folder.path).get(tiny()), made));
    CHECK(read_all(file) == good);
  }
  CHECK(read_packing(file, packing_key(PackingSpec{})) == nullptr);
  CHECK(read_packing(folder.path / "absent.txt", key) == nullptr);
}

TEST_CASE("packing store: numbers are measured once per version of the program", "[dem_core][packing]") {
  const TemporaryFolder folder;
  int num_measured = 0;
  const auto measured = [&](const std::string& version) {
    return PackingStore(folder.path, version).numbers("densest", [&] {
      ++num_measured;
      return PackingStore::Numbers{0.1, -1.0 / 3.0};
    });
  };
  const PackingStore::Numbers first = measured("one");
  const std::filesystem::path file = only_file(folder.path);
  CHECK(measured("one") == first);
  CHECK(num_measured == 1);
  const std::string good = read_all(file);
  std::ofstream(file) << good.substr(0, good.size() - 5);
  CHECK(measured("one") == first);
  CHECK(num_measured == 2);
  measured("two");
  CHECK(num_measured == 3);
  measured("");  // of no version: kept in memory only
  measured("");
  CHECK(num_measured == 5);
}

TEST_CASE("packing store: a folder that cannot be written only costs time", "[dem_core][packing]") {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "file") << "not a folder";
  PackingStore store(folder.path / "file" / "below");
  CHECK(same_bits(*store.get(tiny()), make_packing(tiny())));
  CHECK_FALSE(write_packing(folder.path / "file" / "below" / "x.txt", "key", Packing{}));
}
