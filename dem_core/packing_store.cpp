// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/packing_store.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace tilth {
namespace {

/// Raise when make_packing() gives other bits.
constexpr int packing_version = 1;

/// FNV-1a; only names the file, the key inside decides.
std::uint64_t file_hash(const std::string& key) {
  std::uint64_t h = 1469598103934665603ULL;
  for (const char c : key) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

bool write_beside_and_rename(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  const std::filesystem::path draft =
      file.string() + fmt::format(".{}.{:x}", ::getpid(), reinterpret_cast<std::uintptr_t>(&text));
  std::ofstream out(draft);
  out << text;
  out.close();
  if (out) std::filesystem::rename(draft, file, error);
  if (!out || error) {
    std::error_code ignored;
    std::filesystem::remove(draft, ignored);
    return false;
  }
  return true;
}

PackingStore::Numbers read_numbers(const std::filesystem::path& file, const std::string& key) {
  std::ifstream in(file);
  std::string word;
  if (!in || !std::getline(in, word) || word != key) return {};
  PackingStore::Numbers values;
  while (in >> word && word != "end") values.push_back(std::strtod(word.c_str(), nullptr));
  return word == "end" ? values : PackingStore::Numbers();
}

}  // namespace

std::string packing_key(const PackingSpec& s) {
  const bool box = s.shape == ContainerShape::box;
  return fmt::format("tilth packing {} {} {:a} {:a} {:a} {:a} n={} porosity={:a} spread={:a} seed={}",
                     packing_version, box ? "box" : "cylinder", box ? 0.0 : s.radius_m,
                     box ? s.size_m.x() : 0.0, box ? s.size_m.y() : 0.0, s.size_m.z(),
                     s.num_particles, s.porosity, s.size_spread, s.seed);
}

std::filesystem::path default_packing_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto cache = variable("XDG_CACHE_HOME"); !cache.empty())
    return cache / "tilth" / "packings";
  if (const auto home = variable("HOME"); !home.empty())
    return home / ".cache" / "tilth" / "packings";
  return {};
}

PackingStore::Numbers PackingStore::numbers(const std::string& key,
                                            const std::function<Numbers()>& make) {
  {
    const std::lock_guard lock(numbers_mutex_);
    if (const auto known = numbers_.find(key); known != numbers_.end()) return known->second;
  }
  // Two threads may both come here; they make the same.
  const std::string full_key = fmt::format("tilth numbers {} {}", version_, key);
  const std::filesystem::path file = version_.empty() ? "" : file_of(full_key);
  Numbers found;
  if (!file.empty()) found = read_numbers(file, full_key);
  if (found.empty()) {
    found = make();
    if (!file.empty() && !found.empty())
      write_beside_and_rename(file, fmt::format("{}\n{:a}\nend\n", full_key, fmt::join(found, "\n")));
  }
  const std::lock_guard lock(numbers_mutex_);
  if (!found.empty()) numbers_.emplace(key, found);
  return found;
}

std::shared_ptr<const Packing> read_packing(const std::filesystem::path& file,
                                            const std::string& key) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line) || line != key) return nullptr;
  auto packing = std::make_shared<Packing>();
  std::size_t n = 0;
  std::string a, b;
  if (!(in >> n >> a >> b) || n > 10'000'000) return nullptr;
  packing->mean_radius_m = std::strtod(a.c_str(), nullptr);
  packing->largest_overlap = std::strtod(b.c_str(), nullptr);
  for (std::size_t i = 0; i < n; ++i) {
    double v[4];
    for (double& x : v) {
      if (!(in >> a)) return nullptr;
      x = std::strtod(a.c_str(), nullptr);
    }
    packing->position_m.emplace_back(v[0], v[1], v[2]);
    packing->radius_m.push_back(v[3]);
  }
  if (!(in >> a) || a != "end") return nullptr;
  return packing;
}

bool write_packing(const std::filesystem::path& file, const std::string& key,
                   const Packing& packing) {
  std::string text = fmt::format("{}\n{} {:a} {:a}\n", key, packing.radius_m.size(),
                                 packing.mean_radius_m, packing.largest_overlap);
  for (std::size_t i = 0; i < packing.radius_m.size(); ++i) {
    const Vec3& x = packing.position_m[i];
    text += fmt::format("{:a} {:a} {:a} {:a}\n", x.x(), x.y(), x.z(), packing.radius_m[i]);
  }
  return write_beside_and_rename(file, text + "end\n");
}

PackingStore::PackingStore(std::filesystem::path folder, std::string version)
    : folder_(std::move(folder)), version_(std::move(version)) {}

std::filesystem::path PackingStore::file_of(const std::string& key) const {
  return folder_.empty() ? folder_ : folder_ / fmt::format("{:016x}.txt", file_hash(key));
}

std::shared_ptr<const Packing> PackingStore::get(const PackingSpec& spec) {
  const std::string key = packing_key(spec);
  std::shared_ptr<Slot> slot;
  {
    const std::lock_guard lock(mutex_);
    auto& entry = slots_[key];
    if (!entry) entry = std::make_shared<Slot>();
    slot = entry;
  }
  std::call_once(slot->made, [&] {
    const std::filesystem::path file = file_of(key);
    if (!file.empty()) slot->packing = read_packing(file, key);
    if (slot->packing) return;
    const auto made = std::make_shared<Packing>(make_packing(spec));
    if (!file.empty()) write_packing(file, key, *made);
    slot->packing = made;
  });
  return slot->packing;
}

}  // namespace tilth
