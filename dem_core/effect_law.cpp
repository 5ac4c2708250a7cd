// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dem_core/effect_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tilth {

bool attracts(const EffectLaw& e) {
  return e.capillary_Pa > 0 || e.tool_adhesion_Pa > 0 || e.healing_Pa > 0;
}

bool acts(const EffectLaw& e) {
  return attracts(e) || e.bond_softening > 0 || e.rate_strengthening > 0 ||
         e.stiffness_exponent > 0 || e.contact_plasticity > 0 || e.crushing_compliance_per_Pa > 0;
}

std::vector<std::string> problems(const EffectLaw& e) {
  std::vector<std::string> found;
  const auto require = [&found](bool ok, const char* name, double value, const char* range) {
    if (!ok) found.push_back(fmt::format("{} = {}: must be {}", name, value, range));
  };
  const auto from_zero = [&](const char* name, double x) {
    require(std::isfinite(x) && x >= 0, name, x, "finite and >= 0");
  };
  const auto positive = [&](const char* name, double x) {
    require(std::isfinite(x) && x > 0, name, x, "finite and > 0");
  };
  from_zero("bond_softening", e.bond_softening);
  from_zero("rate_strengthening", e.rate_strengthening);
  positive("rate_reference_per_s", e.rate_reference_per_s);
  from_zero("capillary_Pa", e.capillary_Pa);
  from_zero("tool_adhesion_Pa", e.tool_adhesion_Pa);
  require(e.stiffness_exponent >= 0 && e.stiffness_exponent < 0.9, "stiffness_exponent",
          e.stiffness_exponent, "in [0, 0.9)");
  positive("reference_pressure_Pa", e.reference_pressure_Pa);
  require(e.contact_plasticity >= 0 && e.contact_plasticity < 1, "contact_plasticity",
          e.contact_plasticity, "in [0, 1)");
  from_zero("crushing_compliance_per_Pa", e.crushing_compliance_per_Pa);
  from_zero("healing_Pa", e.healing_Pa);
  positive("healing_time_s", e.healing_time_s);
  return found;
}

namespace {
constexpr double softest = 1e-3;
constexpr double stiffest = 4.0;
}  // namespace

double stiffness_bound(const EffectLaw& e) {
  return (e.stiffness_exponent > 0 ? stiffest : 1.0) / (1 - e.contact_plasticity);
}

double stiffening_factor(double exponent, double x) {
  const double rest = 1 - exponent;
  return std::clamp(std::pow(rest, 1 / rest) * std::pow(x, exponent / rest), softest, stiffest);
}

double rate_gain(double rate_strengthening, double rate_over_reference) {
  return 1 + rate_strengthening * std::log1p(rate_over_reference);
}

double healed_share(double age_over_time) { return -std::expm1(-age_over_time); }

}  // namespace tilth
