// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// VTK's XML files as text: points with data, surfaces, and the time series ParaView opens.
#pragma once

#include <string>
#include <vector>

#include "dem_core/model.hpp"

namespace tilth {

/// One number per point.
struct VtkScalars {
  std::string name;  ///< with its unit
  std::vector<double> values;
};

/// One vector per point.
struct VtkVectors {
  std::string name;
  std::vector<Vec3> values;
};

/// A .vtp file (PolyData, ASCII, 7 digits) of single points.
/// @source VTK file formats, "XML file formats": PolyData, vertices one by one
std::string vtp_points(const std::vector<Vec3>& point_m, const std::vector<VtkScalars>& scalars,
                       const std::vector<VtkVectors>& vectors);

/// A .vtp file of a triangle mesh.
std::string vtp_mesh(const Mesh& mesh);

/// One step of a time series.
struct VtkStep {
  double time_s = 0.0;
  std::string file;  ///< beside the .pvd file
};

/// A .pvd file: ParaView opens it as one data set that changes with time.
std::string pvd_series(const std::vector<VtkStep>& steps);

}  // namespace tilth
