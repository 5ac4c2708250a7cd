// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Sums over an assembly in one lane: energies, momenta, coordination.
#pragma once

#include "dem_core/state.hpp"

namespace tilth {

struct Energy {
  double kinetic_J = 0.0;    ///< translation and rotation
  double contacts_J = 0.0;   ///< k_n d^2/2 + k_s s^2/2 + k_r angle^2/2 of grain contacts
  double walls_J = 0.0;      ///< the same of wall contacts
  double tools_J = 0.0;      ///< the same of tool contacts
  double bonds_J = 0.0;      ///< k_n d^2/2 + F_s^2/2k_s + M_b^2/2k_b + M_t^2/2k_t of unbroken bonds
  double gravity_J = 0.0;    ///< -m g . x
  double total_J() const { return kinetic_J + contacts_J + walls_J + tools_J + bonds_J + gravity_J; }
};

/// Needs a workspace that belongs to the state (after a step).
Energy energy(const Model& model, const State& state, const Workspace& workspace, int lane = 0);

Vec3 momentum_kg_m_per_s(const Model& model, const State& state, int lane = 0);

/// About the origin, spin included.
Vec3 angular_momentum_kg_m2_per_s(const Model& model, const State& state, int lane = 0);

/// Mean number of touching neighbours or unbroken bonds per grain.
double coordination(const Model& model, const State& state, int lane = 0);

int num_bonds_held(const Model& model, const State& state, int lane = 0);

}  // namespace tilth
