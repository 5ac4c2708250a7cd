// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/fit_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tilth {

std::string_view to_string(Termination termination) {
  switch (termination) {
    case Termination::not_called:
      return "not_called";
    case Termination::converged:
      return "converged";
    case Termination::no_convergence:
      return "no_convergence";
    case Termination::budget_spent:
      return "budget_spent";
    case Termination::stopped:
      return "stopped";
    case Termination::too_many_failures:
      return "too_many_failures";
    case Termination::under_determined:
      return "under_determined";
    case Termination::bad_input:
      return "bad_input";
  }
  return "unknown";
}

std::string_view to_string(Reachability reachability) {
  switch (reachability) {
    case Reachability::unknown:
      return "unknown";
    case Reachability::reachable:
      return "reachable";
    case Reachability::edge:
      return "edge";
    case Reachability::unreachable:
      return "unreachable";
  }
  return "unknown";
}

std::string_view to_string(ParameterVerdict verdict) {
  switch (verdict) {
    case ParameterVerdict::unknown:
      return "unknown";
    case ParameterVerdict::fixed:
      return "fixed";
    case ParameterVerdict::identified:
      return "identified";
    case ParameterVerdict::one_sided:
      return "one_sided";
    case ParameterVerdict::flat:
      return "flat";
    case ParameterVerdict::bound_limited:
      return "bound_limited";
    case ParameterVerdict::multimodal:
      return "multimodal";
  }
  return "unknown";
}

std::string verdict_words(const FittedParameter& parameter) {
  const std::string word(to_string(parameter.verdict));
  return parameter.limited_by.empty() ? word : fmt::format("{}(by={})", word, parameter.limited_by);
}

TargetResult compared(const Target& t, const TargetPrediction& p) {
  TargetResult r;
  r.name = t.name;
  r.provenance = t.provenance;
  r.log_transform = t.log_transform;
  r.value = t.value;
  r.sigma = t.sigma;
  r.simulated = untransformed(t, p.mean);
  r.seed_sd = std::sqrt(p.variance_of_one);
  r.parameter_sd = p.parameter_sd;
  r.sigma_total = total_sigma(t.sigma, p.variance, 1, 0.0);
  if (t.holdout && std::isfinite(p.parameter_sd))
    r.sigma_total = std::hypot(r.sigma_total, p.parameter_sd);
  r.residual = (p.mean - transformed(t, t.value)) / r.sigma_total;
  return r;
}

bool FitSummary::is_usable() const {
  if (termination == Termination::too_many_failures) return false;
  return std::any_of(starts.begin(), starts.end(), [](const StartResult& s) { return s.usable; });
}

bool FitSummary::holdout_failed() const { return holdout_rms > holdout_limit; }

const TargetConflict* FitSummary::trend_conflict(const std::string& target) const {
  const auto found = std::ranges::find_if(conflicts, [&](const TargetConflict& c) {
    return c.same_statistic && (c.first == target || c.second == target);
  });
  return found == conflicts.end() ? nullptr : &*found;
}

bool FitSummary::has_unreachable_target() const {
  return std::any_of(targets.begin(), targets.end(), [](const TargetResult& target) {
    return target.reachability == Reachability::unreachable;
  });
}

Eigen::VectorXd FitSummary::values() const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = parameters[i].value;
  }
  return result;
}

std::string FitSummary::brief_report() const {
  if (termination == Termination::not_called) return message;
  return fmt::format(
      "{}: {} chi-square {:.4g} (start, one packing) -> {:.4g} (fresh seeds {:.4g}); {} simulations, {} failed",
      to_string(termination), message, chi_square_start, chi_square, chi_square_fresh,
      num_simulations, failures.size());
}

}  // namespace tilth
