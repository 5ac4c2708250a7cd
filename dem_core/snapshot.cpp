// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/snapshot.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <type_traits>

namespace tilth {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::array<char, 8> magic = {'t', 'i', 'l', 't', 'h', 'S', '0', '4'};

/// Visits every array of a State in one fixed order; reading and writing share it.
template <typename StateRef, typename Visit>
void for_each_array(StateRef& s, Visit visit) {
  visit(s.motion);
  visit(s.contacts.row_begin);
  visit(s.contacts.partner);
  visit(s.contacts.touching);
  visit(s.contacts.spring_m);
  visit(s.contacts.rolling_rad);
  visit(s.contacts.effects);
  visit(s.wall_contacts.row_begin);
  visit(s.wall_contacts.particle);
  visit(s.wall_contacts.spring_m);
  visit(s.wall_contacts.rolling_rad);
  visit(s.bonds);
  visit(s.bond_worst);
  visit(s.walls);
  visit(s.wall_force);
  visit(s.tool_contacts.row_begin);
  visit(s.tool_contacts.particle);
  visit(s.tool_contacts.feature);
  visit(s.tool_contacts.spring_m);
  visit(s.tools);
  visit(s.tool_load);
  visit(s.time_s);
  visit(s.active);
}

struct DriveRecord {
  std::array<double, 8> v;
};

DriveRecord flat(const WallDrive& d) {
  return {{d.velocity_m_per_s.x(), d.velocity_m_per_s.y(), d.velocity_m_per_s.z(),
           d.radial_velocity_m_per_s, d.servo_gain_m_per_N_s, d.servo_integral_gain_m_per_N_s2,
           d.target_force_N, d.max_speed_m_per_s}};
}

WallDrive unflat(const DriveRecord& r) {
  return {Vec3(r.v[0], r.v[1], r.v[2]), r.v[3], r.v[4], r.v[5], r.v[6], r.v[7]};
}

std::array<double, 6> flat(const ToolDrive& d) {
  return {d.velocity_m_per_s.x(),           d.velocity_m_per_s.y(),
          d.velocity_m_per_s.z(),           d.angular_velocity_rad_per_s.x(),
          d.angular_velocity_rad_per_s.y(), d.angular_velocity_rad_per_s.z()};
}

ToolDrive unflat(const std::array<double, 6>& v) {
  return {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])};
}

template <typename T>
void put(std::ostream& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
T take(std::istream& in) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value{};
  in.read(reinterpret_cast<char*>(&value), sizeof value);
  if (!in) throw std::runtime_error("ends early");
  return value;
}

State read_state(std::istream& in) {
  if (take<std::array<char, 8>>(in) != magic) throw std::runtime_error("is not a tilth snapshot");
  State state;
  state.num_lanes = take<int>(in);
  state.num_steps = take<std::int64_t>(in);
  const auto num_drives = take<std::uint64_t>(in);
  for (std::uint64_t k = 0; k < num_drives; ++k) state.drives.push_back(unflat(take<DriveRecord>(in)));
  const auto num_tool_drives = take<std::uint64_t>(in);
  for (std::uint64_t k = 0; k < num_tool_drives; ++k)
    state.tool_drives.push_back(unflat(take<std::array<double, 6>>(in)));
  for_each_array(state, [&in](auto& array) {
    using T = typename std::remove_reference_t<decltype(array)>::value_type;
    const auto n = take<std::uint64_t>(in);
    if (n > (1ULL << 34) / sizeof(T)) throw std::runtime_error("is damaged");
    array.resize(n);
    in.read(reinterpret_cast<char*>(array.data()), static_cast<std::streamsize>(n * sizeof(T)));
    if (!in) throw std::runtime_error("ends early");
  });
  if (in.peek() != std::istream::traits_type::eof()) throw std::runtime_error("is damaged");
  return state;
}

}  // namespace

void save_snapshot(const State& state, const std::filesystem::path& file) {
  const std::filesystem::path draft = file.string() + ".part";
  std::ofstream out(draft, std::ios::binary);
  put(out, magic);
  put(out, state.num_lanes);
  put(out, state.num_steps);
  put(out, static_cast<std::uint64_t>(state.drives.size()));
  for (const WallDrive& d : state.drives) put(out, flat(d));
  put(out, static_cast<std::uint64_t>(state.tool_drives.size()));
  for (const ToolDrive& d : state.tool_drives) put(out, flat(d));
  for_each_array(state, [&out](const auto& array) {
    using T = typename std::remove_cvref_t<decltype(array)>::value_type;
    put(out, static_cast<std::uint64_t>(array.size()));
    out.write(reinterpret_cast<const char*>(array.data()),
              static_cast<std::streamsize>(array.size() * sizeof(T)));
  });
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
  std::filesystem::rename(draft, file);
}

State load_snapshot(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  try {
    return read_state(in);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(file.string() + " " + e.what());
  }
}

}  // namespace tilth
