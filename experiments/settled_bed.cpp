// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/settled_bed.hpp"

#include "dem_core/diagnostics.hpp"

namespace tilth {

double agitation(const LaneRun& run, int lane) {
  const Model& model = run.specimen.model;
  double weight_N = 0.0;
  for (const double mass_kg : model.mass_kg) weight_N += mass_kg * model.gravity_m_per_s2.norm();
  return energy(model, run.specimen.state, run.workspace, lane).kinetic_J /
         (weight_N * run.specimen.mean_radius_m);
}

}  // namespace tilth
