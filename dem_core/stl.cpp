// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/stl.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace tilth {
namespace {

static_assert(std::endian::native == std::endian::little);  // as binary STL

using Triangles = std::vector<std::array<Vec3, 3>>;
constexpr std::size_t header_bytes = 84;
constexpr std::size_t triangle_bytes = 50;

template <typename T>
T number_at(const std::string& bytes, std::size_t position) {
  T value{};
  std::memcpy(&value, bytes.data() + position, sizeof value);
  return value;
}

bool is_binary(const std::string& bytes) {
  return bytes.size() >= header_bytes &&
         bytes.size() == header_bytes + triangle_bytes * number_at<std::uint32_t>(bytes, 80);
}

Triangles read_binary(const std::string& bytes) {
  Triangles triangles;
  for (std::size_t p = header_bytes; p < bytes.size(); p += triangle_bytes) {
    auto& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 9; ++k)
      corners[k / 3][static_cast<Eigen::Index>(k % 3)] =
          static_cast<double>(number_at<float>(bytes, p + 12 + 4 * k));
  }
  return triangles;
}

Triangles read_ascii(const std::string& bytes) {
  std::istringstream in(bytes);
  Triangles triangles;
  std::string word;
  std::size_t num_corners = 0;
  bool ended = false;
  in >> word;
  if (word != "solid" && bytes.size() >= header_bytes)
    throw std::runtime_error(fmt::format(
        "is neither ASCII STL (begins with 'solid') nor whole binary STL: {} triangles take {} "
        "bytes, it "
        "has {}; it is cut off in triangle {}, or no STL",
        number_at<std::uint32_t>(bytes, 80),
        header_bytes + triangle_bytes * std::size_t{number_at<std::uint32_t>(bytes, 80)},
        bytes.size(), (bytes.size() - header_bytes) / triangle_bytes));
  if (word != "solid")
    throw std::runtime_error(
        "is neither ASCII STL (begins with 'solid') nor binary STL (its length "
        "does not fit its triangle count)");
  while (in >> word) {
    ended = ended || word == "endsolid";
    if (word == "facet" && num_corners % 3 != 0)
      throw std::runtime_error(fmt::format("facet {} has not three vertices", num_corners / 3 + 1));
    if (word != "vertex") continue;
    Vec3 v;
    if (!(in >> v.x() >> v.y() >> v.z()))
      throw std::runtime_error(fmt::format("vertex {} is not three numbers", num_corners + 1));
    if (num_corners % 3 == 0) triangles.emplace_back();
    triangles.back()[num_corners++ % 3] = v;
  }
  if (!ended || num_corners % 3 != 0) throw std::runtime_error("ends early");
  return triangles;
}

/// Corner coordinates are finite; triangles that are one line or point are left out or refused.
Triangles without_collapsed(const Triangles& all, std::vector<std::string>& repairs) {
  Triangles kept;
  for (std::size_t t = 0; t < all.size(); ++t) {
    const auto& [a, b, c] = all[t];
    if (!a.allFinite() || !b.allFinite() || !c.allFinite())
      throw std::runtime_error(
          fmt::format("triangle {} has a corner that is not a finite number", t));
    if (a == b || b == c || c == a) continue;
    const double longest2 =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if (!((b - a).cross(c - a).norm() > 1e-9 * longest2))
      throw std::runtime_error(
          fmt::format("triangle {} has no area: its corners lie on one line", t));
    kept.push_back(all[t]);
  }
  if (kept.size() < all.size())
    repairs.push_back(fmt::format("{} triangles with two corners in one point were left out",
                                  all.size() - kept.size()));
  return kept;
}

/// The triangles as a solid, turned if all of it faces inwards.
Mesh solid_of(const Triangles& triangles, std::vector<std::string>& repairs) {
  Mesh mesh = merge_vertices(triangles);
  std::vector<std::string> found = problems(mesh);
  if (found.size() == 1 && mesh_volume_m3(mesh) < 0) {
    for (auto& t : mesh.triangle) std::swap(t[1], t[2]);
    found = problems(mesh);
    if (found.empty()) repairs.push_back("all triangles faced inwards and were turned");
  }
  if (found.empty()) return mesh;
  for (const std::string& done : repairs) found.push_back("(" + done + ")");
  throw std::runtime_error(fmt::format("is no closed solid: {}", fmt::join(found, "; ")));
}

}  // namespace

Mesh read_stl(const std::filesystem::path& file, double metres_per_unit,
              std::vector<std::string>* repairs) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::string> done;
  try {
    const Triangles all = is_binary(bytes) ? read_binary(bytes) : read_ascii(bytes);
    Mesh mesh = solid_of(without_collapsed(all, done), done);
    for (Vec3& v : mesh.vertex_m) v *= metres_per_unit;
    if (repairs) *repairs = done;
    return mesh;
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(file.string() + " " + e.what());
  }
}

void write_stl(const Mesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "solid tilth\n";
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Vec3 n = triangle_normal(mesh, t);
    out << fmt::format("facet normal {:.17g} {:.17g} {:.17g}\n outer loop\n", n.x(), n.y(), n.z());
    for (const std::int32_t id : mesh.triangle[t]) {
      const Vec3& v = mesh.vertex_m[static_cast<std::size_t>(id)];
      out << fmt::format("  vertex {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
    }
    out << " endloop\nendfacet\n";
  }
  out << "endsolid tilth\n";
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace tilth
