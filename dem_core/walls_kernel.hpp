// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The loop over wall contacts: planes (unbounded or rectangles with edges) and cylinders.
#pragma once

#include "dem_core/forces_kernel.hpp"

namespace tilth::lanes {

template <int W>
struct WallMeeting {
  Pack<W> distance;   ///< from the grain's centre to the wall, negative behind an unbounded plane
  Pack3<W> normal;    ///< from the wall to the grain
};

template <int W>
TILTH_INLINE Pack3<W> all3(const double* v) {
  return {Pack<W>::all(v[0]), Pack<W>::all(v[1]), Pack<W>::all(v[2])};
}

/// x beyond +-half, 0 within.
template <int W>
TILTH_INLINE Pack<W> beyond(Pack<W> x, double half) {
  using P = Pack<W>;
  const P h = P::all(half);
  const P zero = P::all(0.0);
  const P low = zero - h;
  return select(x > h, x - h, select(x < low, x - low, zero));
}

template <int W>
TILTH_INLINE WallMeeting<W> meet_wall(const WallView& wall, const double* place,
                                      const Pack3<W>& position) {
  using P = Pack<W>;
  const Pack3<W> direction = all3<W>(wall.direction);
  const Pack3<W> offset = position - Pack3<W>::load(place);
  const P along = dot(offset, direction);
  if (wall.cylinder) {
    const Pack3<W> radial = offset - along * direction;
    const P squared = dot(radial, radial);
    const P tiny = P::all(1e-300);
    const P from_axis = sqrt(select(squared > tiny, squared, tiny));
    const P inward = P::all(-1.0) / from_axis;
    return {P::load(place + 3 * W) - from_axis, inward * radial};
  }
  if (!wall.bounded) return {along, direction};
  const Pack3<W> tangent_a = all3<W>(wall.tangent_a);
  const Pack3<W> tangent_b = all3<W>(wall.tangent_b);
  const P da = beyond(dot(offset, tangent_a), wall.half_a_m);
  const P db = beyond(dot(offset, tangent_b), wall.half_b_m);
  const P outside2 = da * da + db * db;
  const P zero = P::all(0.0);
  const Mask<W> at_edge = outside2 > zero;
  if (!wall.has_edges) return {select(at_edge, P::all(1e300), along), direction};
  const P edge_distance = sqrt(select(at_edge, outside2 + along * along, P::all(1.0)));
  const P inverse = P::all(1.0) / edge_distance;
  const Pack3<W> from_edge =
      inverse * (along * direction + da * tangent_a + db * tangent_b);
  return {select(at_edge, edge_distance, along), select(at_edge, from_edge, direction)};
}

template <int W, bool HasRolling, bool HasEffects>
TILTH_INLINE void wall_contact(const StepView& view, const Law<W>& law, int wall, std::int64_t c) {
  using P = Pack<W>;
  const std::int64_t i = view.wall_particle[c];
  const WallRecord& record = view.wall_pairs[c];
  const double* place = view.walls + static_cast<std::int64_t>(wall) * 4 * W;
  const double* wall_motion = view.wall_velocity + static_cast<std::int64_t>(wall) * 4 * W;
  double* spring_m = view.wall_spring_m + c * 3 * W;
  const double* motion = view.motion + i * 9 * W;
  const Pack3<W> position = Pack3<W>::load(motion);
  const WallMeeting<W> meeting = meet_wall<W>(view.wall_views[wall], place, position);
  const P reference = P::all(record.reference_m);
  const Mask<W> touching = meeting.distance < reference;
  Adhesion<W> sticky = {touching, P::all(0.0), P::all(0.0)};
  if constexpr (HasEffects)
    sticky = adhesion<W>(law, view.radius_m[i],
                         record.glued ? 0.0 : view.wall_views[wall].adhesion_scale,
                         meeting.distance - reference);
  if (!record.glued && !any(touching) && !(HasEffects && any(sticky.near))) {
    Pack3<W>::zero().store(spring_m);
    if (HasRolling) Pack3<W>::zero().store(view.wall_rolling_rad + c * 3 * W);
    return;
  }
  Encounter<W> e;
  e.distance = meeting.distance;
  e.normal = meeting.normal;
  // The wall's surface moves with its body and, for a cylinder, with the growth of its radius.
  const Pack3<W> surface = Pack3<W>::load(wall_motion) -
                           P::load(wall_motion + 3 * W) * e.normal;
  const Pack3<W> relative = Pack3<W>::load(motion + 3 * W) - surface;
  const P opening_speed = dot(relative, e.normal);
  e.closing_speed = P::all(0.0) - opening_speed;
  const Pack3<W> spin = Pack3<W>::load(motion + 6 * W);
  e.sliding_velocity =
      relative - opening_speed * e.normal - cross(meeting.distance * spin, e.normal);
  const P overlap = reference - meeting.distance;
  const P stiffness = law[law_contact_stiffness] * P::all(record.stiffness_factor);
  const P damping_factor = P::all(record.damping_factor);
  const P friction = law[law_wall_friction] * P::all(view.wall_views[wall].friction_scale);
  ContactForce<W> f;
  if (record.glued)
    f = glue_force(law, overlap, stiffness, damping_factor, e, spring_m);
  else if constexpr (HasEffects)
    f = sticky_force(law, friction, touching, sticky, stiffness * overlap, stiffness, damping_factor,
                     e, spring_m);
  else
    f = contact_force<W>(law, friction, touching, stiffness * overlap, stiffness, damping_factor, e,
                         spring_m);
  const Pack3<W> on_grain = f.normal * e.normal - f.tangential;
  double* force = view.force + i * 6 * W;
  (Pack3<W>::load(force) + on_grain).store(force);
  Pack3<W> turning = meeting.distance * cross(e.normal, f.tangential);
  Pack3<W> moment = Pack3<W>::zero();
  if (HasRolling) {
    // The grain is body b here, the wall at rest body a.
    moment = rolling_moment<W>(law, touching,
                               {P::all(view.radius_m[i]),
                                law[law_contact_stiffness] * P::all(record.stiffness_factor) *
                                    law[law_shear_ratio],
                                f.normal, e.normal, spin, spin},
                               view.wall_rolling_rad + c * 3 * W);
    turning = turning - moment;
  }
  (Pack3<W>::load(force + 3 * W) + turning).store(force + 3 * W);
  double* on_wall = view.wall_force + static_cast<std::int64_t>(wall) * 6 * W;
  (Pack3<W>::load(on_wall) - on_grain).store(on_wall);
  const Pack3<W> arm = position - meeting.distance * e.normal - Pack3<W>::load(place);
  Pack3<W> wall_torque = Pack3<W>::load(on_wall + 3 * W) - cross(arm, on_grain);
  if (HasRolling) wall_torque = wall_torque + moment;
  wall_torque.store(on_wall + 3 * W);
}

template <int W, bool HasRolling, bool HasEffects = false>
TILTH_INLINE void accumulate_wall_forces(const StepView& view, const Law<W>& law) {
  for (int wall = 0; wall < view.num_walls; ++wall) {
    double* on_wall = view.wall_force + static_cast<std::int64_t>(wall) * 6 * W;
    Pack3<W>::zero().store(on_wall);
    Pack3<W>::zero().store(on_wall + 3 * W);
    for (std::int64_t c = view.wall_row_begin[wall]; c < view.wall_row_begin[wall + 1]; ++c)
      wall_contact<W, HasRolling, HasEffects>(view, law, wall, c);
  }
}

}  // namespace tilth::lanes
