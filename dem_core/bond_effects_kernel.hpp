// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The parallel bond with strengths of its own, rate dependence and softening over Pack<W>. Formulas:
// docs/theory/effects.md, 1 to 3. Lanes at the null values get the bits of bond_force().
#pragma once

#include "dem_core/bond_kernel.hpp"
#include "dem_core/pair_effects_kernel.hpp"

namespace tilth::lanes {

/// What a bond has beside its geometry where effects act.
struct BondExtras {
  const double* strength;  ///< [W] factor on both strengths, or null
  double* worst;           ///< [W] largest utilisation so far, where bonds soften
};

template <int W>
struct BondLimits {
  Pack<W> tensile, cohesion;
};

/// Both limits raised by the rate at which the bond is strained; `over` lanes only, for log is dear.
template <int W>
TILTH_INLINE BondLimits<W> at_rate(const Law<W>& law, const BondGeometry& g, const Encounter<W>& e,
                                   Mask<W> over, const BondLimits<W>& base) {
  using P = Pack<W>;
  const Mask<W> acts = over & (law[law_rate_strengthening] > P::all(0.0));
  if (!any(acts)) return base;
  const P speed = sqrt(e.closing_speed * e.closing_speed + dot(e.sliding_velocity, e.sliding_velocity));
  alignas(64) double c[W];
  alignas(64) double ratio[W];
  law[law_rate_strengthening].store(c);
  (speed / (P::all(g.rest_length_m) * law[law_rate_reference])).store(ratio);
  const P gain =
      lane_by_lane<W>(acts, P::all(1.0), [&](int k) { return rate_gain(c[k], ratio[k]); });
  return {gain * base.tensile, gain * base.cohesion};
}

/// Elastic stresses over their limits, the larger of tension and shear; 1 at the limit.
template <int W>
TILTH_INLINE Pack<W> utilisation(const Law<W>& law, const BondGeometry& g, const BondTrial<W>& t,
                                 const BondLimits<W>& limits, Pack<W> carried_pressure) {
  using P = Pack<W>;
  const P tiny = P::all(1e-30);
  const P bending = sqrt(dot(t.bending, t.bending)) *
                    (law[law_bending_in_tension] * P::all(g.bending_per_area));
  const P pull = bending - t.push * P::all(g.inverse_area);
  const P shear = sqrt(dot(t.shear, t.shear)) * P::all(g.inverse_area) +
                  abs(t.twisting) * (law[law_twisting_in_shear] * P::all(g.twisting_per_area));
  const P room = limits.cohesion + law[law_tan_friction] * carried_pressure;
  const P in_tension = pull / select(limits.tensile > tiny, limits.tensile, tiny);
  const P in_shear = shear / select(room > tiny, room, tiny);
  return select(in_tension > in_shear, in_tension, in_shear);
}

/// Share of its elastic force that a bond carries whose utilisation has been `worst`.
template <int W>
TILTH_INLINE Pack<W> carried_share(Pack<W> worst, Pack<W> softening) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const P one = P::all(1.0);
  const Mask<W> damaged = (worst > one) & (softening > zero);
  const P left = one - (worst - one) / select(damaged, softening, one);
  return select(damaged, select(left > zero, left, zero) / select(damaged, worst, one), one);
}

template <int W>
TILTH_INLINE BondForce<W> bond_force_with_effects(const Law<W>& law, const BondGeometry& g,
                                                  const Encounter<W>& e,
                                                  const Pack3<W>& spin_difference,
                                                  const Pack3<W>& spin_sum, double* bond,
                                                  double* num_broken, const BondExtras& extras) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const P one = P::all(1.0);
  const BondTrial<W> t = bond_trial(law, g, e, spin_difference, spin_sum, bond);
  const P strength = extras.strength ? P::load(extras.strength) : one;
  const BondLimits<W> base = {strength * law[law_tensile_limit], strength * law[law_cohesion_limit]};
  const P softening = law[law_bond_softening];
  const Mask<W> softens = softening > zero;
  P worst = P::load(extras.worst);
  const P pressure = t.push * P::all(g.inverse_area);
  // Shear strength under tension: only the tension that a softened bond still carries counts.
  const P carried_pressure =
      select((pressure < zero) & softens, carried_share(worst, softening) * pressure, pressure);
  const auto fails = [&](const BondLimits<W>& limits) {
    return bond_fails(law, g, t, limits.tensile, limits.cohesion, pressure, carried_pressure);
  };
  Mask<W> over = fails(base);
  const BondLimits<W> limits = at_rate(law, g, e, over, base);
  if (any(over & (law[law_rate_strengthening] > zero))) over = fails(limits);
  const Mask<W> damages = over & softens;
  if (any(damages)) {
    const P now = utilisation(law, g, t, limits, carried_pressure);
    worst = select(damages & (now > worst), now, worst);
  }
  const Mask<W> fatal = (over & !softens) | (softens & (worst > one + softening));
  const BondForce<W> f = settle_bond(law, t, e, fatal, bond, num_broken);
  const Mask<W> holds = P::load(bond + 7 * W) > P::all(0.5);
  select(holds, worst, zero).store(extras.worst);
  const P share = select(holds, carried_share(worst, softening), one);
  return {select(f.normal < zero, share * f.normal, f.normal), share * f.tangential,
          share * f.moment, f.breaks, share * f.last_shear};
}

}  // namespace tilth::lanes
