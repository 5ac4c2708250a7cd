// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/guards.hpp"

#include <algorithm>

namespace tilth {
namespace {

constexpr const char* rate_effect = "rate_dependent_strength";
constexpr const char* rate_gate = "loading_rate";

bool has_name(const Diagnosis& d, const std::string& id) {
  return std::ranges::find(d.effects, id, &NamedEffect::id) != d.effects.end();
}

}  // namespace

void apply_guards(const GuardFacts& facts, Diagnosis& d) {
  const bool too_fast = std::ranges::find(facts.failed_gates, rate_gate) != facts.failed_gates.end();
  if (too_fast && has_name(d, rate_effect)) {
    d.verdict = Verdict::set;
    d.set = {rate_effect, rate_gate};
    for (const NamedEffect& e : d.effects)
      if (e.id != rate_effect) d.set.push_back(e.id);
    d.effects.clear();
    d.reason += "; the simulations load so fast that their own speed moves the statistics: simulate slower before a rate effect is named";
  }
  if (!facts.has_replicates && d.verdict == Verdict::named) {
    d.verdict = Verdict::suggested;
    d.reason += "; nothing was repeated, so the noise is an assumption: a suggestion at most";
  }
}

}  // namespace tilth
