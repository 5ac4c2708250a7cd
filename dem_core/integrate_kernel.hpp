// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Damping and one semi-implicit Euler step over Pack<W>; then the whole step.
#pragma once

#include "dem_core/tools_kernel.hpp"

namespace tilth::lanes {

/// Local non-viscous damping: F - alpha |F| sign(v); nothing at v = 0.
/// @source Cundall & Strack, Geotechnique 29 (1979) 47-65; form as in PFC's "damp"
template <int W>
TILTH_INLINE Pack<W> damped(Pack<W> f, Pack<W> v, Pack<W> alpha) {
  const Pack<W> zero = Pack<W>::all(0.0);
  const Pack<W> brake = alpha * abs(f);
  return select(v > zero, f - brake, select(v < zero, f + brake, f));
}

template <int W>
TILTH_INLINE Pack3<W> damped(const Pack3<W>& f, const Pack3<W>& v, Pack<W> alpha) {
  return {damped(f.x, v.x, alpha), damped(f.y, v.y, alpha), damped(f.z, v.z, alpha)};
}

template <int W>
TILTH_INLINE void integrate(const StepView& view, const Law<W>& law) {
  using P = Pack<W>;
  const P dt = law[law_dt];
  const P alpha = law[law_local_damping];
  const Mask<W> active = law[law_active] > P::all(0.5);
  P fastest = P::all(0.0);
  for (std::int64_t i = 0; i < view.num_particles; ++i) {
    double* motion = view.motion + i * 9 * W;
    double* load = view.force + i * 6 * W;
    const Pack3<W> velocity = Pack3<W>::load(motion + 3 * W);
    const Pack3<W> spin = Pack3<W>::load(motion + 6 * W);
    const P mass = P::all(view.mass_kg[i]);
    const Pack3<W> weight = mass * all3<W>(view.gravity_m_per_s2);
    const Pack3<W> force = damped(Pack3<W>::load(load) + weight, velocity, alpha);
    const Pack3<W> torque = damped(Pack3<W>::load(load + 3 * W), spin, alpha);
    const Pack3<W> v = velocity + (dt * P::all(view.inverse_mass_per_kg[i])) * force;
    const Pack3<W> w = spin + (dt * P::all(view.inverse_inertia_per_kg_m2[i])) * torque;
    const Pack3<W> x = Pack3<W>::load(motion);
    select(active, x + dt * v, x).store(motion);
    select(active, v, velocity).store(motion + 3 * W);
    select(active, w, spin).store(motion + 6 * W);
    const P speed2 = select(active, dot(v, v), P::all(0.0));
    // NaN and infinity count as the largest speed, so that the guard in step() sees them.
    const P guarded = select(speed2 < P::all(1e300), speed2, P::all(1e300));
    fastest = select(guarded > fastest, guarded, fastest);
    Pack3<W>::zero().store(load);
    Pack3<W>::zero().store(load + 3 * W);
  }
  fastest.store(view.max_speed2);
}

template <int W, bool HasRolling>
void accumulate_forces(const StepView& view, const Law<W>& law) {
  if (view.num_bonds > 0) accumulate_pair_forces<W, true, HasRolling>(view, law);
  else accumulate_pair_forces<W, false, HasRolling>(view, law);
  accumulate_wall_forces<W, HasRolling>(view, law);
}

template <int W>
void step_lanes(const StepView& view) {
  const Law<W> law(view.law);
  if (view.has_rolling) accumulate_forces<W, true>(view, law);
  else accumulate_forces<W, false>(view, law);
  if (view.num_tools > 0) accumulate_tool_forces<W>(view, law);
  integrate(view, law);
}

/// One variant only, for it is the rare one: with bonds and rolling springs, whether there are any or not.
template <int W>
void step_lanes_with_effects(const StepView& view) {
  const Law<W> law(view.law);
  accumulate_pair_forces<W, true, true, true>(view, law);
  accumulate_wall_forces<W, true, true>(view, law);
  if (view.num_tools > 0) accumulate_tool_forces<W, true>(view, law);
  integrate(view, law);
}

}  // namespace tilth::lanes
