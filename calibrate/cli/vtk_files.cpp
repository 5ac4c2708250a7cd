// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/vtk_files.hpp"

#include <fmt/format.h>

#include <iterator>

namespace tilth {
namespace {

using Text = fmt::memory_buffer;

template <typename... T>
void add(Text& text, fmt::format_string<T...> form, T&&... values) {
  fmt::format_to(std::back_inserter(text), form, std::forward<T>(values)...);
}

void open_piece(Text& text, std::size_t points, std::size_t vertices, std::size_t polygons) {
  add(text,
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" "
      "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
      points, vertices, polygons);
}

void close_piece(Text& text) { add(text, "</Piece>\n</PolyData>\n</VTKFile>\n"); }

void add_array(Text& text, const std::string& name, const std::vector<double>& values) {
  add(text, "<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", name);
  for (const double v : values) add(text, "{:.7g}\n", v);
  add(text, "</DataArray>\n");
}

void add_array(Text& text, const std::string& name, const std::vector<Vec3>& values) {
  add(text, "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"3\" format=\"ascii\">\n",
      name);
  for (const Vec3& v : values) add(text, "{:.7g} {:.7g} {:.7g}\n", v.x(), v.y(), v.z());
  add(text, "</DataArray>\n");
}

void add_points(Text& text, const std::vector<Vec3>& point_m) {
  add(text, "<Points>\n");
  add_array(text, "position_m", point_m);
  add(text, "</Points>\n");
}

/// Cells of `size` corners each.
void add_cells(Text& text, const char* kind, const std::vector<std::int32_t>& corners, int size) {
  add(text, "<{}>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n", kind);
  for (const std::int32_t c : corners) add(text, "{} ", c);
  add(text, "\n</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n");
  for (int end = size; end <= static_cast<int>(corners.size()); end += size) add(text, "{} ", end);
  add(text, "\n</DataArray>\n</{}>\n", kind);
}

}  // namespace

std::string vtp_points(const std::vector<Vec3>& point_m, const std::vector<VtkScalars>& scalars,
                       const std::vector<VtkVectors>& vectors) {
  Text text;
  open_piece(text, point_m.size(), point_m.size(), 0);
  add(text, "<PointData>\n");
  for (const VtkScalars& s : scalars) add_array(text, s.name, s.values);
  for (const VtkVectors& v : vectors) add_array(text, v.name, v.values);
  add(text, "</PointData>\n");
  add_points(text, point_m);
  std::vector<std::int32_t> corners;
  for (std::size_t i = 0; i < point_m.size(); ++i) corners.push_back(static_cast<std::int32_t>(i));
  add_cells(text, "Verts", corners, 1);
  close_piece(text);
  return fmt::to_string(text);
}

std::string vtp_mesh(const Mesh& mesh) {
  Text text;
  open_piece(text, mesh.vertex_m.size(), 0, mesh.triangle.size());
  add_points(text, mesh.vertex_m);
  std::vector<std::int32_t> corners;
  for (const auto& t : mesh.triangle) corners.insert(corners.end(), t.begin(), t.end());
  add_cells(text, "Polys", corners, 3);
  close_piece(text);
  return fmt::to_string(text);
}

std::string pvd_series(const std::vector<VtkStep>& steps) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const VtkStep& s : steps)
    text +=
        fmt::format("<DataSet timestep=\"{:.7g}\" part=\"0\" file=\"{}\"/>\n", s.time_s, s.file);
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace tilth
