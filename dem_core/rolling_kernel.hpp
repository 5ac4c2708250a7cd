// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Rolling resistance of an unbonded contact over Pack<W>. Formulas and source: contact_law.hpp.
#pragma once

#include "dem_core/bond_kernel.hpp"

namespace tilth::lanes {

/// What the rolling spring of one contact needs beside the law; normal from a to b.
template <int W>
struct Rolling {
  Pack<W> radius;           ///< Rbar
  Pack<W> shear_stiffness;  ///< k_s of the contact
  Pack<W> normal_force;     ///< F_n, positive pushes apart
  Pack3<W> normal;
  Pack3<W> spin_difference;  ///< spin_b - spin_a
  Pack3<W> spin_sum;         ///< spin_a + spin_b
};

/// Moment on a; b receives the opposite. `resisting` lanes only: the others, and lanes without rolling
/// friction, get zero and an emptied spring.
template <int W>
TILTH_INLINE Pack3<W> rolling_moment(const Law<W>& law, Mask<W> resisting, const Rolling<W>& r,
                                     double* angle_rad) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const P dt = law[law_dt];
  const P friction = law[law_rolling_friction];
  const Mask<W> acts = resisting & (friction > zero);
  const P turn = (P::all(0.5) * dt) * dot(r.spin_sum, r.normal);
  const Pack3<W> rolling = r.spin_difference - dot(r.spin_difference, r.normal) * r.normal;
  Pack3<W> angle = carried(Pack3<W>::load(angle_rad), r.normal, turn) + dt * rolling;
  const P stiffness = r.shear_stiffness * (r.radius * r.radius);
  const P limit = friction * r.radius * select(r.normal_force > zero, r.normal_force, zero);
  const P squared = (stiffness * stiffness) * dot(angle, angle);
  const Mask<W> yields = (squared > limit * limit) & acts;
  if (any(yields)) {
    const P share = select(yields, limit / sqrt(select(yields, squared, P::all(1.0))), P::all(1.0));
    angle = share * angle;
  }
  const Pack3<W> none = Pack3<W>::zero();
  select(acts, angle, none).store(angle_rad);
  return select(acts, stiffness * angle, none);
}

}  // namespace tilth::lanes
