// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Laws beyond the baseline, one lane's numbers; all at their null values: the baseline bit for bit.
// Formulas with their sources and tests: docs/theory/effects.md.
#pragma once

#include <string>
#include <vector>

namespace tilth {

struct EffectLaw {
  double bond_softening = 0.0;          ///< zeta >= 0: a bond fails at (1 + zeta) times its elastic limit
  double rate_strengthening = 0.0;      ///< C >= 0 in 1 + C ln(1 + rate / reference)
  double rate_reference_per_s = 1.0;    ///< > 0; no effect of its own
  double capillary_Pa = 0.0;            ///< F_0 / (4 Rbar)^2 of unbonded contacts, >= 0
  double tool_adhesion_Pa = 0.0;        ///< c_a on tools and adhesive walls, >= 0
  double stiffness_exponent = 0.0;      ///< m in [0, 0.9): tangent stiffness ~ (F / F_ref)^m
  double reference_pressure_Pa = 50e3;  ///< F_ref = this x pi r_min^2, > 0; no effect of its own
  double contact_plasticity = 0.0;      ///< lambda in [0, 1): unloading is 1 / (1 - lambda) times as stiff
  double crushing_compliance_per_Pa = 0.0;  ///< 1 / sigma_a >= 0: F_n <= sigma_a pi r_min^2
  double healing_Pa = 0.0;              ///< strength an old unbonded contact regains, >= 0
  double healing_time_s = 1.0;          ///< t_h > 0; no effect of its own
};

/// True where the kernels of the baseline do not do.
bool acts(const EffectLaw& law);

/// True where grains or tools attract at a distance.
bool attracts(const EffectLaw& law);

/// Everything wrong with the numbers, one sentence each.
std::vector<std::string> problems(const EffectLaw& law);

/// Gap over the grain radius (of a pair: over 2 Rbar) at which attraction ends.
inline constexpr double attraction_range_over_radius = 0.1;

/// Tributary area of a grain's contact on a tool over the square of its radius; see effects.md, 6.
inline constexpr double tool_area_over_radius2 = 4.3;

/// Largest secant stiffness of a contact over its baseline: what the stable time step must allow for.
///   4 where m > 0 (stiffening_factor is cut there), times 1 / (1 - lambda)
double stiffness_bound(const EffectLaw& law);

/// Secant stiffness over k_0 of a contact whose tangent stiffness is k_0 (F / F_ref)^m:
///   F = F_ref ((1 - m) x)^(1 / (1 - m)),  x = k_0 d / F_ref;  F / (k_0 d), cut to [1e-3, 4].
/// @param x >= 0; 0 gives the lower cut
double stiffening_factor(double exponent, double x);

/// 1 + C ln(1 + rate / reference), rate >= 0.
double rate_gain(double rate_strengthening, double rate_over_reference);

/// 1 - exp(-age / t_h).
double healed_share(double age_over_time);

}  // namespace tilth
