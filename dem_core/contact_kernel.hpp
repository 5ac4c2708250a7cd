// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Laws of one contact and one bond over Pack<W>. Formulas: contact_law.hpp and bond.hpp.
#pragma once

#include "dem_core/pack.hpp"
#include "dem_core/view_kernel.hpp"

namespace tilth::lanes {

/// Constants of all lanes, loaded once per step.
template <int W>
struct Law {
  using P = Pack<W>;
  explicit TILTH_INLINE Law(const double* law) : base(law) {}
  TILTH_INLINE P operator[](LawRow row) const { return P::load(base + row * W); }
  const double* base;
};

/// Geometry and relative motion of two touching bodies a and b; normal from a to b.
template <int W>
struct Encounter {
  Pack<W> distance;
  Pack3<W> normal;
  Pack<W> closing_speed;     ///< overlap rate, positive while approaching
  Pack3<W> sliding_velocity;  ///< of b against a in the contact plane
};

template <int W>
struct ContactForce {
  Pack<W> normal;        ///< on b along the normal, positive pushes apart
  Pack3<W> tangential;  ///< on a; b receives the opposite
};

/// Linear spring-dashpot with Coulomb slip and history; see contact_law.hpp.
/// `touching` lanes only; the others get zero force and an emptied spring. `elastic` is the static
/// normal force, k_n d in the baseline; k_n also gives the shear stiffness. HasShearRoom: the limit of
/// the tangential force is `shear_room` above Coulomb's.
template <int W, bool HasShearRoom = false>
TILTH_INLINE ContactForce<W> contact_force(const Law<W>& law, Pack<W> friction, Mask<W> touching,
                                           Pack<W> elastic, Pack<W> normal_stiffness,
                                           Pack<W> damping_factor, const Encounter<W>& e,
                                           double* spring_m,
                                           Pack<W> shear_room = Pack<W>::all(0.0)) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const P normal = elastic + damping_factor * law[law_normal_damping] * e.closing_speed;
  // The spring is carried along with the contact plane: what leaves the plane is projected out.
  Pack3<W> spring = Pack3<W>::load(spring_m) + law[law_dt] * e.sliding_velocity;
  spring = spring - dot(spring, e.normal) * e.normal;
  const P shear_stiffness = normal_stiffness * law[law_shear_ratio];
  const Pack3<W> dashpot = (damping_factor * law[law_tangential_damping]) * e.sliding_velocity;
  Pack3<W> tangential = shear_stiffness * spring + dashpot;
  P limit = friction * select(normal > zero, normal, zero);
  if constexpr (HasShearRoom) limit = limit + shear_room;
  const P squared = dot(tangential, tangential);
  const Mask<W> slipping = (squared > limit * limit) & touching;
  if (any(slipping)) {
    const P scale = select(slipping, limit / sqrt(squared), P::all(1.0));
    tangential = scale * tangential;
    const P inverse = P::all(1.0) / shear_stiffness;
    spring = select(slipping, inverse * (tangential - dashpot), spring);
  }
  select(touching, spring, Pack3<W>::zero()).store(spring_m);
  return {select(touching, normal, zero), select(touching, tangential, Pack3<W>::zero())};
}

/// The same springs and dashpots glued together: they pull as well as push and never slip.
template <int W>
TILTH_INLINE ContactForce<W> glue_force(const Law<W>& law, Pack<W> overlap,
                                        Pack<W> normal_stiffness, Pack<W> damping_factor,
                                        const Encounter<W>& e, double* spring_m) {
  const Pack<W> normal = normal_stiffness * overlap +
                         damping_factor * law[law_normal_damping] * e.closing_speed;
  Pack3<W> spring = Pack3<W>::load(spring_m) + law[law_dt] * e.sliding_velocity;
  spring = spring - dot(spring, e.normal) * e.normal;
  spring.store(spring_m);
  const Pack<W> shear_stiffness = normal_stiffness * law[law_shear_ratio];
  return {normal, shear_stiffness * spring +
                      (damping_factor * law[law_tangential_damping]) * e.sliding_velocity};
}

}  // namespace tilth::lanes
