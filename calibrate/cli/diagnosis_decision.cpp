// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/diagnosis_decision.hpp"

#include <algorithm>

#include "calibrate/diagnosis/guards.hpp"

namespace tilth {
namespace {

constexpr std::size_t max_contenders = 3;
constexpr double least_inclusion = 0.02;  ///< of a contender that is not named

}  // namespace

Diagnosis decided(const std::vector<SoilCase>& soils, const DiagnosisOptions& options) {
  Diagnosis d;
  std::string why;
  for (const SoilCase& s : soils)
    if (!s.failure.empty()) why += (why.empty() ? "" : "; ") + s.campaign.means.id + ": " + s.failure;
  if (!why.empty()) {
    d.reason = why;
    return d;
  }
  std::vector<SoilEvidence> evidence;
  for (const SoilCase& s : soils) evidence.push_back(s.evidence);
  d = diagnose(evidence, options);
  GuardFacts facts;
  for (const SoilCase& s : soils) {
    facts.has_replicates = facts.has_replicates && s.campaign.has_replicates;
    for (const NumericalGate& g : s.gates)
      if (!g.passed()) facts.failed_gates.push_back(g.id);
  }
  apply_guards(facts, d);
  return d;
}

std::vector<std::vector<std::size_t>> contenders_of(const Diagnosis& d) {
  std::vector<std::vector<std::size_t>> models;
  std::vector<std::size_t> named;
  for (const NamedEffect& e : d.effects) named.push_back(e.effect);
  if (!named.empty()) models.push_back(named);
  std::vector<std::size_t> order(static_cast<std::size_t>(d.posterior.inclusion.size()));
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::size_t k) { return d.posterior.inclusion[static_cast<Eigen::Index>(k)]; });
  const bool wants_rivals = !named.empty() || d.verdict == Verdict::set || d.verdict == Verdict::outside_catalogue;
  for (const std::size_t k : order) {
    if (!wants_rivals || models.size() >= max_contenders) break;
    const bool is_named = std::ranges::find(named, k) != named.end();
    const bool likely = d.posterior.inclusion[static_cast<Eigen::Index>(k)] > least_inclusion;
    // one rival at least stands beside a name
    if (!is_named && (likely || models.size() < 2)) models.push_back({k});
  }
  return models;
}

}  // namespace tilth
