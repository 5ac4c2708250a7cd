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
TILTH_INLINE void integrate(const StepView& view, const Law<W>& law, const BlockView& block) {
  using P = Pack<W>;
  const P dt = law[law_dt];
  const P alpha = law[law_local_damping];
  const Mask<W> active = law[law_active] > P::all(0.5);
  P fastest = P::all(0.0);
  for (std::int64_t i = block.row_from; i < block.row_to; ++i) {
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
  fastest.store(block.max_speed2);
}

/// All rows in one block: no cross pairs.
TILTH_INLINE BlockView whole(const StepView& view) {
  return {0, view.num_particles, 0, 0, nullptr, 0, view.max_speed2, view.num_broken};
}

/// Bonds that break are counted per block.
TILTH_INLINE StepView counting_in(const StepView& view, const BlockView& block) {
  StepView own = view;
  own.num_broken = block.num_broken;
  return own;
}

template <int W, bool HasRolling>
void pair_forces(const StepView& view, const Law<W>& law, const BlockView& block) {
  if (view.num_bonds > 0) accumulate_pair_forces<W, true, HasRolling>(view, law, block);
  else accumulate_pair_forces<W, false, HasRolling>(view, law, block);
}

/// One variant only, for it is the rare one: with bonds and rolling springs, whether there are any or not.
template <int W>
void pair_forces_with_effects(const StepView& view, const Law<W>& law, const BlockView& block) {
  accumulate_pair_forces<W, true, true, true>(view, law, block);
}

template <int W>
void BlockStep<W>::cross_forces(const StepView& view, const BlockView& block, std::int64_t from, std::int64_t to) {
  const StepView own = counting_in(view, block);
  if (view.has_rolling) fill_cross_forces<W, true, false>(own, Law<W>(view.law), from, to);
  else fill_cross_forces<W, false, false>(own, Law<W>(view.law), from, to);
}

template <int W>
void BlockStep<W>::block_forces(const StepView& view, const BlockView& block) {
  const StepView own = counting_in(view, block);
  const Law<W> law(view.law);
  add_cross_forces_on_j<W>(own, block);
  if (view.has_rolling) pair_forces<W, true>(own, law, block);
  else pair_forces<W, false>(own, law, block);
  add_cross_forces_on_i<W>(own, block);
}

template <int W>
void BlockStep<W>::rigid_forces(const StepView& view) {
  const Law<W> law(view.law);
  if (view.has_rolling) accumulate_wall_forces<W, true>(view, law);
  else accumulate_wall_forces<W, false>(view, law);
  if (view.num_tools > 0) accumulate_tool_forces<W>(view, law);
}

template <int W>
void BlockStep<W>::move_block(const StepView& view, const BlockView& block) {
  integrate(view, Law<W>(view.law), block);
}

template <int W>
void step_lanes(const StepView& view) {
  const Law<W> law(view.law);
  if (view.has_rolling) pair_forces<W, true>(view, law, whole(view));
  else pair_forces<W, false>(view, law, whole(view));
  BlockStep<W>::rigid_forces(view);
  integrate(view, law, whole(view));
}

template <int W>
void BlockStepWithEffects<W>::cross_forces(const StepView& view, const BlockView& block, std::int64_t from,
                                           std::int64_t to) {
  fill_cross_forces<W, true, true>(counting_in(view, block), Law<W>(view.law), from, to);
}

template <int W>
void BlockStepWithEffects<W>::block_forces(const StepView& view, const BlockView& block) {
  const StepView own = counting_in(view, block);
  add_cross_forces_on_j<W>(own, block);
  pair_forces_with_effects<W>(own, Law<W>(view.law), block);
  add_cross_forces_on_i<W>(own, block);
}

template <int W>
void BlockStepWithEffects<W>::rigid_forces(const StepView& view) {
  const Law<W> law(view.law);
  accumulate_wall_forces<W, true, true>(view, law);
  if (view.num_tools > 0) accumulate_tool_forces<W, true>(view, law);
}

template <int W>
void step_lanes_with_effects(const StepView& view) {
  const Law<W> law(view.law);
  pair_forces_with_effects<W>(view, law, whole(view));
  BlockStepWithEffects<W>::rigid_forces(view);
  integrate(view, law, whole(view));
}

}  // namespace tilth::lanes
