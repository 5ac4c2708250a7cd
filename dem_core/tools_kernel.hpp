// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The loop over tool contacts: grains against faces, edges and vertices of moving meshes.
#pragma once

#include "dem_core/walls_kernel.hpp"

namespace tilth::lanes {

/// Pose and motion of one tool in every lane.
template <int W>
struct ToolMotion {
  Pack3<W> position, axis_x, axis_y, axis_z, velocity, spin;
  TILTH_INLINE explicit ToolMotion(const double* m)
      : position(Pack3<W>::load(m)),
        axis_x(Pack3<W>::load(m + 3 * W)),
        axis_y(Pack3<W>::load(m + 6 * W)),
        axis_z(Pack3<W>::load(m + 9 * W)),
        velocity(Pack3<W>::load(m + 12 * W)),
        spin(Pack3<W>::load(m + 15 * W)) {}
  TILTH_INLINE Pack3<W> to_body(const Pack3<W>& x) const {
    const Pack3<W> arm = x - position;
    return {dot(arm, axis_x), dot(arm, axis_y), dot(arm, axis_z)};
  }
  TILTH_INLINE Pack3<W> to_world(const Pack3<W>& v) const {
    return v.x * axis_x + v.y * axis_y + v.z * axis_z;
  }
};

template <int W>
struct FeatureMeeting {
  Pack<W> distance;
  Pack3<W> normal;    ///< body frame, from the tool to the grain
  Mask<W> near;       ///< within reach of the feature's plane, line or point
};

/// Distance and direction from a feature to a point of the body frame, its region left aside.
template <int W>
TILTH_INLINE FeatureMeeting<W> meet_feature(const MeshFeature& feature, double max_depth_m,
                                            const Pack3<W>& centre, Pack<W> reach) {
  using P = Pack<W>;
  const Pack3<W> direction = all3<W>(feature.direction);
  const Pack3<W> offset = centre - all3<W>(feature.point_m);
  const P along = dot(offset, direction);
  if (feature.kind == FeatureKind::face)
    return {along, direction, (along < reach) & !(along < P::all(-max_depth_m))};
  const Pack3<W> away = feature.kind == FeatureKind::edge ? offset - along * direction : offset;
  const P squared = dot(away, away);
  const P tiny = P::all(1e-300);
  const P distance = sqrt(select(squared > tiny, squared, tiny));
  return {distance, (P::all(1.0) / distance) * away, distance < reach};
}

template <int W>
TILTH_INLINE Mask<W> within_region(const ToolView& tool, const MeshFeature& feature,
                                   const Pack3<W>& centre, Mask<W> inside) {
  using P = Pack<W>;
  for (int k = feature.half_space_begin; k < feature.half_space_end && any(inside); ++k) {
    const HalfSpace& h = tool.half_spaces[k];
    const P s = dot(all3<W>(h.normal), centre) - P::all(h.offset_m);
    inside = inside & (h.closed ? !(s < P::all(0.0)) : s > P::all(0.0));
  }
  return inside;
}

template <int W, bool HasEffects>
TILTH_INLINE void tool_contact(const StepView& view, const Law<W>& law, const ToolView& tool,
                               const ToolMotion<W>& body, const Pack3<W>& centre, double* load,
                               std::int64_t c) {
  using P = Pack<W>;
  const std::int64_t i = view.tool_particle[c];
  const WallRecord& record = view.tool_pairs[c];
  const MeshFeature& feature = tool.features[view.tool_feature[c]];
  double* spring_m = view.tool_spring_m + c * 3 * W;
  const P reference = P::all(record.reference_m);
  P reach = reference;
  if constexpr (HasEffects)
    if (any(law[law_tool_adhesion] > P::all(0.0)))
      reach = reference + P::all(attraction_range_over_radius * view.radius_m[i]);
  const FeatureMeeting<W> meeting = meet_feature<W>(feature, tool.max_depth_m, centre, reach);
  Mask<W> touching = meeting.near;
  if (any(touching)) touching = within_region(tool, feature, centre, touching);
  Adhesion<W> sticky = {touching, P::all(0.0), P::all(0.0)};
  if constexpr (HasEffects) {
    sticky = adhesion<W>(law, view.radius_m[i], 1.0, meeting.distance - reference);
    sticky.near = sticky.near & touching;
    touching = touching & (meeting.distance < reference);
  }
  if (!any(touching) && !(HasEffects && any(sticky.near))) {
    Pack3<W>::zero().store(spring_m);
    return;
  }
  const double* motion = view.motion + i * 9 * W;
  Encounter<W> e;
  e.distance = meeting.distance;
  e.normal = body.to_world(meeting.normal);
  const Pack3<W> arm = Pack3<W>::load(motion) - meeting.distance * e.normal - body.position;
  const Pack3<W> relative =
      Pack3<W>::load(motion + 3 * W) - (body.velocity + cross(body.spin, arm));
  const P opening_speed = dot(relative, e.normal);
  e.closing_speed = P::all(0.0) - opening_speed;
  e.sliding_velocity = relative - opening_speed * e.normal -
                       cross(meeting.distance * Pack3<W>::load(motion + 6 * W), e.normal);
  const P stiffness = law[law_contact_stiffness] * P::all(record.stiffness_factor);
  const P elastic = stiffness * (reference - meeting.distance);
  ContactForce<W> f;
  if constexpr (HasEffects)
    f = sticky_force(law, law[law_tool_friction], touching, sticky, elastic, stiffness,
                     P::all(record.damping_factor), e, spring_m);
  else
    f = contact_force<W>(law, law[law_tool_friction], touching, elastic, stiffness,
                         P::all(record.damping_factor), e, spring_m);
  const Pack3<W> none = Pack3<W>::zero();
  const Mask<W> acting = HasEffects ? touching | sticky.near : touching;
  const Pack3<W> on_grain = select(acting, f.normal * e.normal - f.tangential, none);
  double* force = view.force + i * 6 * W;
  (Pack3<W>::load(force) + on_grain).store(force);
  const Pack3<W> turning =
      select(acting, meeting.distance * cross(e.normal, f.tangential), none);
  (Pack3<W>::load(force + 3 * W) + turning).store(force + 3 * W);
  (Pack3<W>::load(load) - on_grain).store(load);
  const Pack3<W> torque = select(acting, cross(arm, on_grain), none);
  (Pack3<W>::load(load + 3 * W) - torque).store(load + 3 * W);
  const P one = select(touching, P::all(1.0), P::all(0.0));
  (P::load(load + 6 * W) + one).store(load + 6 * W);
}

template <int W, bool HasEffects = false>
TILTH_INLINE void accumulate_tool_forces(const StepView& view, const Law<W>& law) {
  for (int t = 0; t < view.num_tools; ++t) {
    double* load = view.tool_load + static_cast<std::int64_t>(t) * 7 * W;
    Pack3<W>::zero().store(load);
    Pack3<W>::zero().store(load + 3 * W);
    Pack<W>::all(0.0).store(load + 6 * W);
    const ToolMotion<W> body(view.tool_motion + static_cast<std::int64_t>(t) * 18 * W);
    std::int64_t last = -1;
    Pack3<W> centre = Pack3<W>::zero();
    for (std::int64_t c = view.tool_row_begin[t]; c < view.tool_row_begin[t + 1]; ++c) {
      const std::int64_t i = view.tool_particle[c];
      if (i != last) centre = body.to_body(Pack3<W>::load(view.motion + i * 9 * W));
      last = i;
      tool_contact<W, HasEffects>(view, law, view.tool_views[t], body, centre, load, c);
    }
  }
}

}  // namespace tilth::lanes
