// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The parallel bond over Pack<W>. Formulas and source: bond.hpp.
#pragma once

#include "dem_core/bond.hpp"
#include "dem_core/contact_kernel.hpp"

namespace tilth::lanes {

template <int W>
struct BondForce {
  Pack<W> normal;        ///< on b along the normal, positive pushes apart
  Pack3<W> tangential;  ///< on a
  Pack3<W> moment;      ///< bending and twisting, on a
  Mask<W> breaks;       ///< lanes whose bond broke in this step
  Pack3<W> last_shear;  ///< shear force a breaking bond would have carried
};

/// A stored vector follows its bond: it turns with the bond's spin about the normal and is
/// projected into the plane perpendicular to the new normal (first order in the step's rotation).
template <int W>
TILTH_INLINE Pack3<W> carried(const Pack3<W>& v, const Pack3<W>& normal, Pack<W> turn_rad) {
  const Pack3<W> turned = v + turn_rad * cross(normal, v);
  return turned - dot(turned, normal) * normal;
}

/// Both strength criteria without a square root: |v| a > rhs  <=>  rhs < 0 or v^2 a^2 > rhs^2.
template <int W>
TILTH_INLINE Mask<W> exceeds(const Pack3<W>& v, Pack<W> factor, Pack<W> rhs) {
  const Pack<W> zero = Pack<W>::all(0.0);
  return (rhs < zero) | (dot(v, v) * (factor * factor) > rhs * rhs);
}

/// What a bond would carry if it held.
template <int W>
struct BondTrial {
  Pack<W> push;  ///< on b along the normal, positive pushes apart
  Pack3<W> shear, bending;
  Pack<W> twisting;
};

/// `spin_sum` = spin_a + spin_b.
template <int W>
TILTH_INLINE BondTrial<W> bond_trial(const Law<W>& law, const BondGeometry& g,
                                     const Encounter<W>& e, const Pack3<W>& spin_difference,
                                     const Pack3<W>& spin_sum, const double* bond) {
  using P = Pack<W>;
  const P dt = law[law_dt];
  const P turn = (P::all(0.5) * dt) * dot(spin_sum, e.normal);
  const P push = (law[law_bond_normal] * P::all(g.normal_factor)) *
                 (P::all(g.rest_length_m) - e.distance);
  const Pack3<W> shear = carried(Pack3<W>::load(bond), e.normal, turn) +
                         (law[law_bond_shear] * P::all(g.shear_factor) * dt) * e.sliding_velocity;
  const P twist_rate = dot(spin_difference, e.normal);
  const Pack3<W> bend_rate = spin_difference - twist_rate * e.normal;
  const Pack3<W> bending = carried(Pack3<W>::load(bond + 3 * W), e.normal, turn) +
                           (law[law_bond_bending] * P::all(g.bending_factor) * dt) * bend_rate;
  const P twisting = P::load(bond + 6 * W) +
                     (law[law_bond_twisting] * P::all(g.twisting_factor) * dt) * twist_rate;
  return {push, shear, bending, twisting};
}

/// Torn or sheared; pressures are compression positive.
template <int W>
TILTH_INLINE Mask<W> bond_fails(const Law<W>& law, const BondGeometry& g, const BondTrial<W>& t,
                                Pack<W> tensile_limit, Pack<W> cohesion_limit, Pack<W> pressure,
                                Pack<W> pressure_in_shear) {
  using P = Pack<W>;
  const Mask<W> torn = exceeds(t.bending, law[law_bending_in_tension] * P::all(g.bending_per_area),
                               tensile_limit + pressure);
  const P shear_room =
      cohesion_limit + law[law_tan_friction] * pressure_in_shear -
      abs(t.twisting) * (law[law_twisting_in_shear] * P::all(g.twisting_per_area));
  return torn | exceeds(t.shear, P::all(g.inverse_area), shear_room);
}

/// Breaks the bonds in `fails` that hold in active lanes, stores what the others remember, and gives their
/// forces; broken lanes give zero and stay broken.
template <int W>
TILTH_INLINE BondForce<W> settle_bond(const Law<W>& law, const BondTrial<W>& t,
                                      const Encounter<W>& e, Mask<W> fails, double* bond,
                                      double* num_broken) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const P one = P::all(1.0);
  const Mask<W> held = P::load(bond + 7 * W) > P::all(0.5);
  const Mask<W> active = law[law_active] > P::all(0.5);
  const Mask<W> breaks = fails & held & active;
  if (any(breaks)) {
    (P::load(num_broken) + select(breaks, one, zero)).store(num_broken);
  }
  const Mask<W> holds = held & !breaks;
  const Pack3<W> none = Pack3<W>::zero();
  const Pack3<W> shear_now = select(holds, t.shear, none);
  const Pack3<W> bending_now = select(holds, t.bending, none);
  const P twisting_now = select(holds, t.twisting, zero);
  shear_now.store(bond);
  bending_now.store(bond + 3 * W);
  twisting_now.store(bond + 6 * W);
  select(holds, one, zero).store(bond + 7 * W);
  return {select(holds, t.push, zero), shear_now, bending_now + twisting_now * e.normal, breaks,
          t.shear};
}

/// One step of one bond.
template <int W>
TILTH_INLINE BondForce<W> bond_force(const Law<W>& law, const BondGeometry& g,
                                     const Encounter<W>& e, const Pack3<W>& spin_difference,
                                     const Pack3<W>& spin_sum, double* bond, double* num_broken) {
  const BondTrial<W> t = bond_trial(law, g, e, spin_difference, spin_sum, bond);
  const Pack<W> pressure = t.push * Pack<W>::all(g.inverse_area);
  const Mask<W> fails = bond_fails(law, g, t, law[law_tensile_limit], law[law_cohesion_limit],
                                   pressure, pressure);
  return settle_bond(law, t, e, fails, bond, num_broken);
}

}  // namespace tilth::lanes
