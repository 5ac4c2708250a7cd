// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What does not change during a run: grains, laws of every lane, bonds as made, walls and tools as
// shapes.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "dem_core/aligned.hpp"
#include "dem_core/bond.hpp"
#include "dem_core/effect_law.hpp"

namespace tilth {

using Vec3 = Eigen::Vector3d;

/// How the numbers in LaneLaw become the stiffness of one contact.
enum class StiffnessKind {
  modulus,     ///< k_n = E_c pi r_min^2 / (r_a + r_b); a wall contact has k_n = E_c pi r
  per_contact  ///< k_n is the number itself, for every pair and wall contact alike
};

/// How the numbers in LaneLaw become the dashpot of one contact.
enum class DampingKind {
  restitution,  ///< c_n = normal_damping sqrt(m_eff k_n), with normal_damping = 2 zeta
  rate          ///< c_n = normal_damping m_eff, normal_damping in 1/s
};

/// The laws of one lane (one parameter set), as numbers. Dimensionless unless the name has a unit.
struct LaneLaw {
  double contact_stiffness = 0.0;      ///< E_c [Pa] or k_n [N/m], see StiffnessKind; >= 0
  double shear_stiffness_ratio = 0.5;  ///< k_s / k_n, > 0
  double friction = 0.5;               ///< Coulomb coefficient between grains, >= 0
  double wall_friction = 0.0;          ///< Coulomb coefficient on walls, >= 0; see friction_scale
  double rolling_friction = 0.0;       ///< mu_r of unbonded contacts and of walls, >= 0 (rolling.md)
  double tool_friction = 0.0;          ///< Coulomb coefficient on tools, >= 0
  double normal_damping = 0.0;         ///< see DampingKind, >= 0
  double tangential_damping = 0.0;     ///< see DampingKind (with m_eff k_n), >= 0
  double local_damping = 0.0;          ///< alpha in F - alpha |F| sign(v), in [0, 1)
  BondLaw bond;                        ///< constants of the bonds, multiplied with BondGeometry
  EffectLaw effects = {};              ///< laws beyond the baseline; null unless asked for
  double dt_s = 0.0;                   ///< time step of this lane, > 0
};

enum class WallShape { plane, cylinder };

/// A rigid wall. A plane keeps grains on the side its normal points to; a cylinder keeps them inside.
/// Position, velocity and radius belong to State, since every lane may move a wall differently.
struct Wall {
  WallShape shape = WallShape::plane;
  Vec3 direction = Vec3::UnitZ();  ///< plane: unit normal into the specimen; cylinder: unit axis
  Vec3 position_m = Vec3::Zero();  ///< a point of the plane or of the axis at the start
  double radius_m = 0.0;           ///< cylinder only, at the start
  /// A plane may be bounded to a rectangle: |(x - position) . tangent_a| <= half_a, same for b.
  /// Outside it a grain meets the rectangle's edge, or nothing where has_edges is false.
  Vec3 tangent_a = Vec3::UnitX();
  Vec3 tangent_b = Vec3::UnitY();
  double half_a_m = std::numeric_limits<double>::infinity();
  double half_b_m = std::numeric_limits<double>::infinity();
  bool has_edges = true;
  double friction_scale = 1.0;  ///< times wall_friction of the lane: 0 greases this wall alone, >= 0
  double adhesion_scale = 0.0;  ///< times tool_adhesion_Pa of the lane: 1 makes it a tool's surface, >= 0

  bool bounded() const {
    return half_a_m < std::numeric_limits<double>::infinity() ||
           half_b_m < std::numeric_limits<double>::infinity();
  }
};

/// Triangles seen counter-clockwise from outside; see mesh.hpp for what makes them a solid.
struct Mesh {
  std::vector<Vec3> vertex_m;
  std::vector<std::array<std::int32_t, 3>> triangle;
};

/// A rigid body with prescribed motion whose surface is a mesh in its own frame. Its pose belongs to
/// State, since every lane may move it differently; here is the pose at the start.
struct Tool {
  Mesh mesh;                       ///< in the body frame; the tool turns about its origin
  Vec3 position_m = Vec3::Zero();  ///< of the body frame's origin
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< body frame to world
  /// A grain whose centre is further than this behind a face is let go. A face pushes only outwards,
  /// and a grain let go inside the tool stays there unnoticed; must be below half the thinnest part.
  double max_depth_m = 0.0;
};

/// Distance at which a pair carries no contact force, where it is not r_i + r_j.
struct ReferenceDistance {
  std::int32_t i = 0;
  std::int32_t j = 0;
  double distance_m = 0.0;
};

/// A wall contact that overlapped when the wall was placed: the distance that counts as touching.
struct WallReference {
  std::int32_t wall = 0;
  std::int32_t particle = 0;
  double distance_m = 0.0;
  /// Glued for good: the contact's springs and dashpots act at any distance, in tension too, and the
  /// tangential one never slips.
  bool glued = false;
};

/// The same for a tool: holds for every feature of its mesh.
struct ToolReference {
  std::int32_t tool = 0;
  std::int32_t particle = 0;
  double distance_m = 0.0;
};

struct Model {
  std::vector<double> radius_m;
  std::vector<double> mass_kg;
  /// The first grains keep the velocity they are given (0 unless set) whatever pushes them: a rough base.
  int num_fixed = 0;
  std::vector<LaneLaw> lanes;  ///< 1, 4 or 8 of them
  StiffnessKind stiffness_kind = StiffnessKind::modulus;
  DampingKind damping_kind = DampingKind::restitution;
  /// True: the contact acts beside an unbroken bond, as in Potyondy & Cundall 2004, section 2.2.
  /// False: a bonded pair carries its bond alone and its contact only after breakage, beginning with
  /// the bond's last shear force, cut back to Coulomb's limit.
  bool contact_beside_bond = true;
  std::vector<BondGeometry> bonds;            ///< sorted by (i, j), i < j
  /// [bond][lane]: factor on both strengths of a bond, > 0; empty means 1 everywhere.
  AlignedDoubles bond_strength;
  std::vector<ReferenceDistance> references;  ///< sorted by (i, j), i < j
  std::vector<WallReference> wall_references;
  std::vector<Wall> walls;
  std::vector<Tool> tools;
  std::vector<ToolReference> tool_references;
  Vec3 gravity_m_per_s2 = Vec3::Zero();
  double skin_m = 0.0;  ///< Verlet margin; 0 means 0.3 times the smallest radius

  int num_particles() const { return static_cast<int>(radius_m.size()); }
  int num_lanes() const { return static_cast<int>(lanes.size()); }
};

/// Effective radius of a rolling contact, Rbar = r_i r_j / (r_i + r_j); the grain's own on a wall.
double rolling_radius_m(const Model& model, int i, int j);

/// Everything wrong with a model, one sentence each; empty means usable.
std::vector<std::string> problems(const Model& model);

/// Mass of solid spheres, m = 4/3 pi r^3 rho.
std::vector<double> sphere_masses_kg(const std::vector<double>& radius_m, double density_kg_per_m3);

/// Dashpot number 2 zeta that makes a head-on impact of linear contacts rebound with e:
///   zeta = -ln e / sqrt(pi^2 + ln^2 e),   c_n = 2 zeta sqrt(m_eff k_n).
/// The force may turn attractive just before separation; clipping it would give a larger e.
/// @param restitution e in (0, 1]
/// @source damped harmonic oscillator, half a period; e.g. Schwager & Poeschel,
///         Granular Matter 9 (2007) 465-469
double damping_number(double restitution);

}  // namespace tilth
