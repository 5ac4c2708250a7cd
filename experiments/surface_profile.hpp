// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The surface of a bed across the travel, before and after a tool.
#pragma once

#include <vector>

#include "dem_core/model.hpp"

namespace tilth {

/// The stretch from_m <= x <= to_m of a bed that lies in |y| <= width / 2.
struct ProfileFrame {
  double from_m = 0.0;
  double to_m = 0.0;
  double width_m = 0.0;
  double cell_m = 0.0;  ///< wanted width of a cell; the whole width is divided evenly
};

/// A quantity over y, the middle of each cell.
struct Profile {
  std::vector<double> lateral_m = {};
  std::vector<double> height_m = {};
  double cell_m = 0.0;
};

/// Mean height of the spheres' upper envelope over each cell of y, averaged along the stretch:
///   z(x, y) = max over spheres above the point of  z_i + sqrt(r_i^2 - d^2)
/// taken at points a quarter of a mean diameter apart; points without a sphere count as 0, the
/// floor.
Profile surface_profile(const std::vector<Vec3>& position_m, const std::vector<double>& radius_m,
                        const ProfileFrame& frame);

/// Areas of a cross-section between two profiles of equal cells.
struct FurrowArea {
  double furrow_m2 = 0.0;  ///< where the surface went down
  double ridge_m2 = 0.0;   ///< where it rose
};

FurrowArea furrow_area(const Profile& before, const Profile& after);

}  // namespace tilth
