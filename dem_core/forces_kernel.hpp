// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The loop over pairs. Pairs are visited in (i, j) order, so sums never depend on the list's length.
#pragma once

#include "dem_core/bond_effects_kernel.hpp"
#include "dem_core/bond_kernel.hpp"
#include "dem_core/contact_kernel.hpp"
#include "dem_core/records.hpp"
#include "dem_core/rolling_kernel.hpp"

namespace tilth::lanes {

template <int W>
struct Body {
  Pack3<W> position, velocity, spin;
  TILTH_INLINE static Body load(const double* motion) {
    return {Pack3<W>::load(motion), Pack3<W>::load(motion + 3 * W),
            Pack3<W>::load(motion + 6 * W)};
  }
};

template <int W>
TILTH_INLINE void clear_spring(double* spring_m, std::uint8_t& touching) {
  if (!touching) return;
  Pack3<W>::zero().store(spring_m);
  touching = 0;
}

/// Rbar of two grains.
TILTH_INLINE double rolling_radius_m(const StepView& view, std::int64_t i, std::int64_t j) {
  return view.radius_m[i] * view.radius_m[j] / (view.radius_m[i] + view.radius_m[j]);
}

/// Section of two grains' contact, that of the smaller one.
TILTH_INLINE double contact_area_m2(const StepView& view, std::int64_t i, std::int64_t j) {
  const double r = view.radius_m[i] < view.radius_m[j] ? view.radius_m[i] : view.radius_m[j];
  return 3.14159265358979323846 * r * r;
}

/// A contact that has ended in every lane forgets its springs and what effects remembered.
template <int W, bool HasRolling, bool HasEffects>
TILTH_INLINE void clear_memory(const StepView& view, std::int64_t p, double* spring_m) {
  if (HasRolling && view.touching[p]) Pack3<W>::zero().store(view.pair_rolling_rad + p * 3 * W);
  if (HasEffects && view.touching[p]) {
    Pack<W>::all(0.0).store(view.pair_effects + p * 2 * W);
    Pack<W>::all(0.0).store(view.pair_effects + (p * 2 + 1) * W);
  }
  clear_spring<W>(spring_m, view.touching[p]);
}

template <int W>
TILTH_INLINE BondExtras bond_extras(const StepView& view, std::int64_t bond) {
  return {view.bond_strength ? view.bond_strength + bond * W : nullptr,
          view.bond_worst + bond * W};
}

/// What one listed pair (i, j) adds: on_b to the force of j and its negative to that of i, the turns to their torques.
template <int W>
struct PairForce {
  bool acts;  ///< in some lane; else nothing is to be added
  Pack3<W> on_b, turn_a, turn_b;
};

/// Force and moments of one listed pair. HasBonds = false leaves
/// the bond, HasRolling = false the rolling spring and HasEffects = false the laws of effect_law.hpp out
/// of the code; the bits are those of a model without bonds, and of lanes without rolling friction or
/// effects, either way.
template <int W, bool HasBonds, bool HasRolling, bool HasEffects>
TILTH_INLINE PairForce<W> pair_force(const StepView& view, const Law<W>& law, const Body<W>& a,
                                     std::int64_t i, std::int64_t p) {
  using P = Pack<W>;
  const PairRecord& pair = view.pairs[p];
  const std::int64_t j = pair.j;
  double* spring_m = view.pair_spring_m + p * 3 * W;
  const Pack3<W> branch = Pack3<W>::load(view.motion + j * 9 * W) - a.position;
  const P squared = dot(branch, branch);
  const bool bonded = HasBonds && pair.bond >= 0;
  const P reference = P::all(pair.reference_m);
  Mask<W> touching = squared < reference * reference;
  Mask<W> unbonded = touching;
  double* bond = nullptr;
  bool any_bond = false;
  if (bonded) {
    bond = view.bonds + static_cast<std::int64_t>(pair.bond) * 8 * W;
    const Mask<W> holds = P::load(bond + 7 * W) > P::all(0.5);
    any_bond = any(holds);
    unbonded = unbonded & !holds;
    if (!view.contact_beside_bond) touching = touching & !holds;
  }
  // Lanes that attract from a distance; where no bond is in the way.
  Mask<W> near = touching;
  if constexpr (HasEffects) {
    const P reach = reference + P::all(2 * attraction_range_over_radius * rolling_radius_m(view, i, j));
    near = (squared < reach * reach) & attracting(law);
    if (bonded) near = near & !(P::load(bond + 7 * W) > P::all(0.5));
  }
  if (!any_bond && !any(touching) && !(HasEffects && any(near))) {
    clear_memory<W, HasRolling, HasEffects>(view, p, spring_m);
    return {false, Pack3<W>::zero(), Pack3<W>::zero(), Pack3<W>::zero()};
  }
  const Pack3<W> velocity_b = Pack3<W>::load(view.motion + j * 9 * W + 3 * W);
  const Pack3<W> spin_b = Pack3<W>::load(view.motion + j * 9 * W + 6 * W);
  Encounter<W> e;
  e.distance = sqrt(squared);
  e.normal = (P::all(1.0) / e.distance) * branch;
  const P half = P::all(0.5) * e.distance;
  const P arm_a = half + P::all(pair.arm_offset_m);
  const P arm_b = half - P::all(pair.arm_offset_m);
  const Pack3<W> relative = velocity_b - a.velocity;
  const P opening_speed = dot(relative, e.normal);
  e.closing_speed = P::all(0.0) - opening_speed;
  const Pack3<W> rolling = arm_a * a.spin + arm_b * spin_b;
  e.sliding_velocity = relative - opening_speed * e.normal - cross(rolling, e.normal);

  P push = P::all(0.0);
  Pack3<W> tangential = Pack3<W>::zero();
  Pack3<W> moment = Pack3<W>::zero();
  if (any(touching)) {
    P stiffness = law[law_contact_stiffness] * P::all(pair.stiffness_factor);
    const P overlap = reference - e.distance;
    P elastic = P::all(0.0);
    if constexpr (HasEffects) {
      const double area_m2 = contact_area_m2(view, i, j);
      stiffness = stiffened<W>(law, touching, stiffness, overlap, area_m2);
      elastic = yielding_push<W>(law, touching, stiffness, overlap, area_m2, view.pair_effects + p * 2 * W);
    } else {
      elastic = stiffness * overlap;
    }
    const ContactForce<W> f = contact_force<W>(law, law[law_friction], touching, elastic, stiffness,
                                               P::all(pair.damping_factor), e, spring_m);
    push = f.normal;
    tangential = f.tangential;
    view.touching[p] = 1;
    if (HasRolling)
      moment = rolling_moment<W>(law, unbonded,
                                 {P::all(rolling_radius_m(view, i, j)),
                                  stiffness * law[law_shear_ratio], f.normal, e.normal,
                                  spin_b - a.spin, a.spin + spin_b},
                                 view.pair_rolling_rad + p * 3 * W);
  } else {
    clear_memory<W, HasRolling, HasEffects>(view, p, spring_m);
  }
  if constexpr (HasEffects) {
    if (any(near))
      push = push - attraction<W>(law, near, unbonded, e.distance - reference,
                                  rolling_radius_m(view, i, j), view.pair_effects + (p * 2 + 1) * W);
  }
  if (any_bond) {
    BondForce<W> f;
    if constexpr (HasEffects)
      f = bond_force_with_effects(law, view.bond_geometry[pair.bond], e, spin_b - a.spin,
                                  a.spin + spin_b, bond, view.num_broken,
                                  bond_extras<W>(view, pair.bond));
    else
      f = bond_force(law, view.bond_geometry[pair.bond], e, spin_b - a.spin, a.spin + spin_b, bond,
                     view.num_broken);
    push = push + f.normal;
    tangential = tangential + f.tangential;
    moment = HasRolling ? moment + f.moment : f.moment;
    if (!view.contact_beside_bond && any(f.breaks)) {
      // The contact takes over from its bond with the shear force it finds; Coulomb cuts it back.
      const P shear_stiffness = law[law_contact_stiffness] * P::all(pair.stiffness_factor) *
                                law[law_shear_ratio];
      const Pack3<W> taken = (P::all(1.0) / shear_stiffness) * f.last_shear;
      select(f.breaks, taken, Pack3<W>::load(spring_m)).store(spring_m);
      view.touching[p] = 1;
    }
  }
  const Pack3<W> on_b = push * e.normal - tangential;
  const Pack3<W> turning = cross(e.normal, tangential);
  return {true, on_b, arm_a * turning + moment, arm_b * turning - moment};
}

template <int W>
TILTH_INLINE void add_to(double* store, const Pack3<W>& force, const Pack3<W>& torque) {
  (Pack3<W>::load(store) + force).store(store);
  (Pack3<W>::load(store + 3 * W) + torque).store(store + 3 * W);
}

/// Cross pairs [from, to) into their buffer; nothing else of a body is written.
template <int W, bool HasRolling, bool HasEffects>
TILTH_INLINE void fill_cross_forces(const StepView& view, const Law<W>& law, std::int64_t from, std::int64_t to) {
  for (std::int64_t k = from; k < to; ++k) {
    const std::int64_t i = view.cross_row[k];
    const Body<W> a = Body<W>::load(view.motion + i * 9 * W);
    const PairForce<W> f = pair_force<W, true, HasRolling, HasEffects>(view, law, a, i, view.cross_pair[k]);
    view.cross_acts[k] = f.acts;
    double* store = view.cross_force + k * 9 * W;
    f.on_b.store(store);
    f.turn_a.store(store + 3 * W);
    f.turn_b.store(store + 6 * W);
  }
}

/// What earlier blocks do to this one: of every body's terms these come first.
template <int W>
TILTH_INLINE void add_cross_forces_on_j(const StepView& view, const BlockView& block) {
  for (std::int64_t m = 0; m < block.num_cross_in; ++m) {
    const std::int64_t k = block.cross_in[m];
    if (!view.cross_acts[k]) continue;
    const double* f = view.cross_force + k * 9 * W;
    add_to<W>(view.force + static_cast<std::int64_t>(view.pairs[view.cross_pair[k]].j) * 6 * W,
              Pack3<W>::load(f), Pack3<W>::load(f + 6 * W));
  }
}

/// What later blocks do to this one: these come last.
template <int W>
TILTH_INLINE void add_cross_forces_on_i(const StepView& view, const BlockView& block) {
  for (std::int64_t k = block.cross_from; k < block.cross_to; ++k) {
    if (!view.cross_acts[k]) continue;
    const double* f = view.cross_force + k * 9 * W;
    double* store = view.force + static_cast<std::int64_t>(view.cross_row[k]) * 6 * W;
    (Pack3<W>::load(store) - Pack3<W>::load(f)).store(store);
    (Pack3<W>::load(store + 3 * W) + Pack3<W>::load(f + 3 * W)).store(store + 3 * W);
  }
}

template <int W, bool HasBonds, bool HasRolling, bool HasEffects = false>
TILTH_INLINE void accumulate_pair_forces(const StepView& view, const Law<W>& law, const BlockView& block) {
  for (std::int64_t i = block.row_from; i < block.row_to; ++i) {
    const std::int64_t begin = view.row_begin[i];
    const std::int64_t end = view.row_end[i];
    if (begin == end) continue;
    const Body<W> a = Body<W>::load(view.motion + i * 9 * W);
    double* store = view.force + i * 6 * W;
    Pack3<W> force = Pack3<W>::load(store);
    Pack3<W> torque = Pack3<W>::load(store + 3 * W);
    for (std::int64_t p = begin; p < end; ++p) {
      const PairForce<W> f = pair_force<W, HasBonds, HasRolling, HasEffects>(view, law, a, i, p);
      if (!f.acts) continue;
      force = force - f.on_b;
      torque = torque + f.turn_a;
      add_to<W>(view.force + static_cast<std::int64_t>(view.pairs[p].j) * 6 * W, f.on_b, f.turn_b);
    }
    force.store(store);
    torque.store(store + 3 * W);
  }
}

}  // namespace tilth::lanes
