// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Meshes: what makes them a solid, their features, STL files.
#include "dem_core/mesh.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>

#include "dem_core/mesh_features.hpp"
#include "dem_core/stl.hpp"
#include "experiments/tool_shapes.hpp"

using namespace tilth;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;

namespace {

Mesh unit_box() { return box_mesh({0, 0, 0}, {1, 2, 3}); }

struct TemporaryFile {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               ("tilth_mesh_" + std::to_string(::getpid()) + ".stl");
  ~TemporaryFile() { std::filesystem::remove(path); }
  void write(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }
  std::string read() const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

std::string binary_stl(const Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&bytes](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const auto& t : mesh.triangle) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const std::int32_t v : t)
      for (int k = 0; k < 3; ++k)
        put(static_cast<float>(mesh.vertex_m[static_cast<std::size_t>(v)][k]));
    put(std::uint16_t{0});
  }
  return bytes;
}

std::vector<int> feature_counts(const Mesh& mesh) {
  std::vector<int> counts(3, 0);
  for (const MeshFeature& f : mesh_features(mesh).features) ++counts[static_cast<std::size_t>(f.kind)];
  return counts;
}

}  // namespace

TEST_CASE("mesh: parametric tools are closed solids of their volume", "[dem_core][mesh]") {
  const auto check = [](const Mesh& mesh, double volume_m3) {
    CHECK(problems(mesh) == std::vector<std::string>{});
    CHECK_THAT(mesh_volume_m3(mesh), WithinRel(volume_m3, 1e-12));  // rounding
  };
  check(unit_box(), 6.0);
  check(vane_mesh(0.04, 0.08, 0.002), 0.08 * (2 * 0.04 * 0.002 - 0.002 * 0.002));
  const double r = 0.01, shaft = 0.006, tall = r / std::tan(0.25);
  // the sides are placed so that every cross-section has the round body's area
  check(cone_mesh(0.5, 2 * r, 2 * shaft, 0.1, 12),
        std::numbers::pi * (r * r * tall / 3 + shaft * shaft * (0.1 - tall)));
  check(cone_mesh(0.5, 2 * r, 2 * r, 0.1, 7),
        std::numbers::pi * (r * r * tall / 3 + r * r * (0.1 - tall)));
  CHECK_THROWS_WITH(prism_mesh({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 0, 1), Contains("crosses itself"));
}

TEST_CASE("mesh: what is not a solid is said in a sentence", "[dem_core][mesh]") {
  const auto complaint = [](const Mesh& mesh) {
    const auto found = problems(mesh);
    return found.empty() ? std::string("none") : found.front();
  };
  Mesh open = unit_box();
  open.triangle.pop_back();
  CHECK_THAT(complaint(open), Contains("not closed"));
  Mesh flipped = unit_box();
  std::swap(flipped.triangle[3][0], flipped.triangle[3][1]);
  CHECK_THAT(complaint(flipped), Contains("orientation is not consistent"));
  Mesh inside_out = unit_box();
  for (auto& t : inside_out.triangle) std::swap(t[0], t[1]);
  CHECK_THAT(complaint(inside_out), Contains("face inwards"));
  Mesh flat = unit_box();
  flat.vertex_m[1] = flat.vertex_m[0];
  CHECK_THAT(complaint(flat), Contains("degenerate"));
  Mesh wrong = unit_box();
  wrong.triangle[0][0] = 8;
  CHECK_THAT(complaint(wrong), Contains("vertex 8 of 8"));
  CHECK_THAT(complaint(Mesh{}), Contains("at least 4"));
}

TEST_CASE("mesh: flat diagonals and concave edges are no features", "[dem_core][mesh]") {
  // 12 faces, 12 of 18 edges (6 diagonals are flat), 8 corners
  CHECK(feature_counts(unit_box()) == std::vector<int>{12, 12, 8});
  // an L: the inner edge is concave and its ends are no corners: 12 outline corners less 2
  const Mesh l = prism_mesh({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1);
  CHECK(feature_counts(l) == std::vector<int>{20, 17, 10});
  // a vane: 24 corners less 8 concave ones; edges 3 x 12 less 4 concave
  CHECK(feature_counts(vane_mesh(2, 1, 0.1)) == std::vector<int>{44, 32, 16});
  // a hollow box: the cavity's edges and corners are concave
  Mesh hollow = unit_box();
  const Mesh cavity = box_mesh({0.2, 0.2, 0.2}, {0.8, 1.8, 2.8});
  hollow.vertex_m.insert(hollow.vertex_m.end(), cavity.vertex_m.begin(), cavity.vertex_m.end());
  for (const auto& t : cavity.triangle) hollow.triangle.push_back({t[1] + 8, t[0] + 8, t[2] + 8});
  CHECK(problems(hollow) == std::vector<std::string>{});
  CHECK(feature_counts(hollow) == std::vector<int>{24, 12, 8});
}

TEST_CASE("mesh: every point outside a convex body belongs to one feature of those nearest to it",
          "[dem_core][mesh]") {
  // Regions tile the outside: exactly one feature per point, boundaries of the box included. A round
  // body has no exact boundaries; rounding leaves slits of 1e-16 there, so its points are off them.
  struct Case {
    Mesh mesh;
    double shift_m;
  };
  for (const auto& [mesh, shift_m] :
       {Case{unit_box(), 0.0}, Case{cone_mesh(0.6, 2, 2, 5, 9), 1e-3}}) {
    const MeshFeatures built = mesh_features(mesh);
    const auto owners = [&built](const Vec3& x) {
      int count = 0;
      for (const MeshFeature& f : built.features) {
        bool in = true;
        for (int k = f.half_space_begin; k < f.half_space_end; ++k) {
          const HalfSpace& h = built.half_spaces[static_cast<std::size_t>(k)];
          const double s = Vec3(h.normal[0], h.normal[1], h.normal[2]).dot(x) - h.offset_m;
          in = in && (s > 0 || (s == 0 && h.closed));
        }
        const Vec3 n(f.direction[0], f.direction[1], f.direction[2]);
        const Vec3 p(f.point_m[0], f.point_m[1], f.point_m[2]);
        if (f.kind == FeatureKind::face) in = in && n.dot(x - p) > 0;
        count += in ? 1 : 0;
      }
      return count;
    };
    std::vector<Vec3> points;
    for (int i = -4; i <= 12; ++i)
      for (int j = -4; j <= 12; ++j)
        for (const double z : {-1.5, 6.0}) points.emplace_back(0.5 * i + shift_m, 0.5 * j, z);
    int wrong = 0;
    for (const Vec3& x : points) wrong += owners(x) == 1 ? 0 : 1;
    CHECK(wrong == 0);
  }
}

TEST_CASE("stl: ASCII and binary files give the mesh back, in metres", "[dem_core][mesh]") {
  const TemporaryFile file;
  const Mesh cone = cone_mesh(0.5, 0.02, 0.012, 0.1, 12);
  write_stl(cone, file.path);
  const Mesh same = read_stl(file.path, 1.0);
  CHECK(same.vertex_m.size() == cone.vertex_m.size());
  CHECK(same.triangle.size() == cone.triangle.size());
  CHECK(mesh_volume_m3(same) == mesh_volume_m3(cone));  // 17 digits read back exactly
  file.write(binary_stl(unit_box()));
  const Mesh box = read_stl(file.path, 1e-3);  // millimetres
  CHECK(box.vertex_m.size() == 8);
  CHECK_THAT(mesh_volume_m3(box), WithinRel(6e-9, 1e-12));
}

TEST_CASE("stl: broken files are refused with their name and the reason", "[dem_core][mesh]") {
  const TemporaryFile file;
  const auto complaint = [&file](const std::string& bytes) {
    file.write(bytes);
    try {
      read_stl(file.path, 1.0);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("none");
  };
  write_stl(unit_box(), file.path);
  const std::string good = file.read();
  CHECK_THAT(complaint("PNG"), Contains(file.path.string()) && Contains("neither"));
  CHECK_THAT(complaint(good.substr(0, good.size() / 2)), Contains("ends early"));
  CHECK_THAT(complaint("solid x\nfacet\nvertex 1 2\nendfacet\nendsolid"),
             Contains("vertex 1 is not three numbers"));
  CHECK_THAT(complaint("solid x\nfacet\nvertex 1 2 3\nfacet\nendsolid"),
             Contains("facet 1 has not three vertices"));
  std::string open = good;
  open.erase(open.rfind("facet normal"), open.rfind("endfacet") + 9 - open.rfind("facet normal"));
  CHECK_THAT(complaint(open), Contains("not closed"));
  const std::string binary = binary_stl(unit_box());
  CHECK_THAT(complaint(binary.substr(0, binary.size() - 1)), Contains("neither"));
  std::string not_finite = good;
  not_finite.replace(not_finite.find("vertex ", 400), 8, "vertex nan ");
  CHECK_THAT(complaint(not_finite), Contains("vertex") && Contains("is not three numbers"));
  Mesh bad = unit_box();
  bad.vertex_m[bad.triangle[2][0]].x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(complaint(binary_stl(bad)), Contains("has a corner that is not a finite number"));
  Mesh flat = unit_box();
  flat.vertex_m[0] = Vec3(0.5, 1, 0);  // onto the diagonal of its face
  CHECK_THAT(complaint(binary_stl(flat)), Contains("has no area: its corners lie on one line"));
  Mesh mixed = unit_box();
  std::swap(mixed.triangle[3][0], mixed.triangle[3][1]);
  CHECK_THAT(complaint(binary_stl(mixed)), Contains("triangles") && Contains("3") &&
                                               Contains("orientation is not consistent"));
  CHECK_THAT(complaint(binary_stl(unit_box()).substr(0, 84 + 50 * 7 + 20)),
             Contains("cut off in triangle 7"));
  CHECK_THROWS_WITH(read_stl("/nonexistent.stl", 1.0), Contains("cannot read /nonexistent.stl"));
}

TEST_CASE("stl: a surface turned inside out and collapsed triangles are repaired with a note",
          "[dem_core][mesh]") {
  const TemporaryFile file;
  std::vector<std::string> repairs;
  Mesh inside_out = unit_box();
  for (auto& t : inside_out.triangle) std::swap(t[0], t[1]);
  file.write(binary_stl(inside_out));
  CHECK(mesh_volume_m3(read_stl(file.path, 1.0, &repairs)) == 6);
  REQUIRE(repairs.size() == 1);
  CHECK_THAT(repairs.front(), Contains("faced inwards"));
  Mesh with_needles = unit_box();
  with_needles.triangle.push_back({0, 0, 1});
  with_needles.triangle.push_back({2, 2, 2});
  file.write(binary_stl(with_needles));
  const Mesh box = read_stl(file.path, 1.0, &repairs);
  CHECK(box.triangle.size() == 12);
  REQUIRE(repairs.size() == 1);
  CHECK_THAT(repairs.front(), Contains("2 triangles") && Contains("left out"));
  file.write(binary_stl(unit_box()));
  read_stl(file.path, 1.0, &repairs);
  CHECK(repairs.empty());
}
