// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Parametric tools as closed triangle meshes, in the body frame; z is up and the axis.
#pragma once

#include <array>
#include <vector>

#include "dem_core/model.hpp"

namespace tilth {

/// A box between two corners; 12 triangles.
Mesh box_mesh(const Vec3& low_m, const Vec3& high_m);

/// Triangles of a simple polygon (corners counter-clockwise), by cutting off ears; numbers of corners.
/// @throws std::invalid_argument for a polygon that crosses itself
std::vector<std::array<std::int32_t, 3>> triangulate(const std::vector<Eigen::Vector2d>& outline);

/// A prism over a simple polygon (corners counter-clockwise seen from above), from low_m to high_m.
/// @throws std::invalid_argument for a polygon that crosses itself
Mesh prism_mesh(const std::vector<Eigen::Vector2d>& outline_m, double low_m, double high_m);

/// A point (radius, height) of the profile of a body of revolution.
struct ProfilePoint {
  double radius_m = 0.0;
  double height_m = 0.0;
};

/// A body of revolution about z with `num_sides` flat sides, from its lowest point outwards and up to its
/// highest; profile points of radius 0 (first and last only) close it in a tip or a flat end. The
/// sides' corners lie on the radius R sqrt(2 pi / (N sin(2 pi / N))), so that every cross-section has
/// the area pi R^2 of the round body.
Mesh revolution_mesh(const std::vector<ProfilePoint>& profile, int num_sides);

/// A cone, tip down at the origin, on a thinner or equal shaft that reaches to `length_m` above the tip.
///   height of the cone = base_diameter / (2 tan(apex_angle / 2))
/// @param apex_angle_rad  full angle at the tip; 30 degrees in the agricultural standard
Mesh cone_mesh(double apex_angle_rad, double base_diameter_m, double shaft_diameter_m,
               double length_m, int num_sides);

/// A cruciform vane: four blades of the full diameter, height and thickness, its lower end in the
/// plane z = 0, its axis through the origin.
Mesh vane_mesh(double diameter_m, double height_m, double blade_thickness_m);

/// Area of the surface below the plane z = level, in the mesh's own frame.
double area_below_m2(const Mesh& mesh, double level_m);

}  // namespace tilth
