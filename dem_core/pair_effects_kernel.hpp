// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What effects add to one contact over Pack<W>: stiffening, yielding, attraction. Formulas and sources:
// effect_law.hpp and docs/theory/effects.md. Lanes at the null values get the baseline's bits.
#pragma once

#include "dem_core/contact_kernel.hpp"
#include "dem_core/effect_law.hpp"

namespace tilth::lanes {

/// y[k] = f(k) in every lane of the mask; the rest keeps `otherwise`. For laws with pow, exp or log:
/// one scalar function for every lane count.
template <int W, typename F>
TILTH_INLINE Pack<W> lane_by_lane(Mask<W> mask, Pack<W> otherwise, F f) {
  alignas(64) double wanted[W];
  alignas(64) double y[W];
  select(mask, Pack<W>::all(1.0), Pack<W>::all(0.0)).store(wanted);
  otherwise.store(y);
  for (int k = 0; k < W; ++k)
    if (wanted[k] != 0.0) y[k] = f(k);
  return Pack<W>::load(y);
}

/// Lanes in which grains attract before they touch.
template <int W>
TILTH_INLINE Mask<W> attracting(const Law<W>& law) {
  const Pack<W> zero = Pack<W>::all(0.0);
  return (law[law_capillary] > zero) | (law[law_healing] > zero);
}

/// 1 at and below touch, falling to 0 at the gap `range`.
template <int W>
TILTH_INLINE Pack<W> ramp(Pack<W> gap, Pack<W> range) {
  const Pack<W> zero = Pack<W>::all(0.0);
  const Pack<W> one = Pack<W>::all(1.0);
  const Pack<W> rest = one - gap / range;
  return select(gap > zero, select(rest > zero, rest, zero), one);
}

/// k_n of the contact, stiffer or softer with its load where m > 0.
template <int W>
TILTH_INLINE Pack<W> stiffened(const Law<W>& law, Mask<W> touching, Pack<W> stiffness,
                               Pack<W> overlap, double area_m2) {
  using P = Pack<W>;
  const P exponent = law[law_stiffness_exponent];
  const Mask<W> acts = touching & (exponent > P::all(0.0));
  if (!any(acts)) return stiffness;
  alignas(64) double m[W];
  alignas(64) double x[W];
  exponent.store(m);
  (stiffness * overlap / (law[law_reference_pressure] * P::all(area_m2))).store(x);
  const P factor =
      lane_by_lane<W>(acts, P::all(1.0), [&](int k) { return stiffening_factor(m[k], x[k]); });
  return select(acts, factor * stiffness, stiffness);
}

/// Static normal force of a contact that may yield; `plastic_m` is its plastic overlap.
template <int W>
TILTH_INLINE Pack<W> yielding_push(const Law<W>& law, Mask<W> touching, Pack<W> stiffness,
                                   Pack<W> overlap, double area_m2, double* plastic_m) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const P one = P::all(1.0);
  const P linear = stiffness * overlap;
  const P plasticity = law[law_contact_plasticity];
  const P compliance = law[law_crushing_compliance];
  const Mask<W> acts = (plasticity > zero) | (compliance > zero);
  if (!any(acts)) return linear;
  const P unloading = stiffness / (one - plasticity);
  const P strength = P::all(area_m2) / select(compliance > zero, compliance, P::all(1e-300));
  const P limit = select(strength < linear, strength, linear);
  const P plastic = P::load(plastic_m);
  const P trial = unloading * (overlap - plastic);
  const Mask<W> yields = trial > limit;
  const P push = select(yields, limit, select(trial > zero, trial, zero));
  const P plastic_now = select(yields, overlap - limit / unloading, plastic);
  select(acts & touching, plastic_now, zero).store(plastic_m);
  return select(acts, push, linear);
}

/// Attraction of a pair without a bond, positive pulls together; `age_s` counts how long it touches.
template <int W>
TILTH_INLINE Pack<W> attraction(const Law<W>& law, Mask<W> near, Mask<W> touching, Pack<W> gap,
                                double reduced_radius_m, double* age_s) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const double diameter_m = 4 * reduced_radius_m;
  P pull = law[law_capillary] * P::all(diameter_m * diameter_m);
  const P healing = law[law_healing];
  const Mask<W> heals = (healing > zero) & touching;
  if (any(healing > zero)) {
    const P age = select(heals, P::load(age_s) + law[law_dt], zero);
    age.store(age_s);
    alignas(64) double ratio[W];
    (age / law[law_healing_time]).store(ratio);
    const P share = lane_by_lane<W>(heals, zero, [&](int k) { return healed_share(ratio[k]); });
    pull = pull + (healing * P::all(0.25 * 3.14159265358979323846 * diameter_m * diameter_m)) * share;
  }
  const P range = P::all(2 * attraction_range_over_radius * reduced_radius_m);
  return select(near, pull * ramp(gap, range), zero);
}

/// Adhesion of a grain on a tool or wall: pull-off force, and the room it adds to Coulomb's limit.
template <int W>
struct Adhesion {
  Mask<W> near;  ///< within reach of the pull
  Pack<W> pull;
  Pack<W> shear_room;
};

template <int W>
TILTH_INLINE Adhesion<W> adhesion(const Law<W>& law, double radius_m, double scale, Pack<W> gap) {
  using P = Pack<W>;
  const P zero = P::all(0.0);
  const P strength =
      law[law_tool_adhesion] * P::all(scale * tool_area_over_radius2 * radius_m * radius_m);
  const P range = P::all(attraction_range_over_radius * radius_m);
  const Mask<W> near = (gap < range) & (strength > zero);
  return {near, select(near, strength * ramp(gap, range), zero), strength};
}

/// A contact on a tool or wall that sticks: net normal force = elastic - pull, and the tangential one
/// may reach mu max(net, 0) + shear_room.
template <int W>
TILTH_INLINE ContactForce<W> sticky_force(const Law<W>& law, Pack<W> friction, Mask<W> touching,
                                          const Adhesion<W>& sticky, Pack<W> elastic,
                                          Pack<W> stiffness, Pack<W> damping_factor,
                                          const Encounter<W>& e, double* spring_m) {
  const Pack<W> zero = Pack<W>::all(0.0);
  ContactForce<W> f =
      contact_force<W, true>(law, friction, touching, elastic - sticky.pull, stiffness,
                             damping_factor, e, spring_m, sticky.shear_room);
  f.normal = select(sticky.near & !touching, zero - sticky.pull, f.normal);
  return f;
}

}  // namespace tilth::lanes
