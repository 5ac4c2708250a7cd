// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calibrate/fit_stages.hpp"

namespace tilth {
namespace {

constexpr std::size_t most_named = 6;  // the report names all of them in its table

// "a, b, c and 4 more"
std::string list_of(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), most_named);
  const std::string list = fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  return shown == names.size() ? list : fmt::format("{} and {} more", list, names.size() - shown);
}

Gate noise_gate(const FitContext& context) {
  const int seeds = context.summary.num_noise_seeds;
  if (seeds < 2)
    return {"noise floor", false, fmt::format("not measured: {} repeat seeds completed", seeds)};
  double largest = 0.0;
  std::vector<std::string> noisy;
  for (const std::size_t k : context.fitted) {
    const double sd = std::sqrt(context.seed_variance[static_cast<Eigen::Index>(k)]);
    largest = std::max(largest, sd / context.targets[k].sigma);
    if (sd > context.targets[k].sigma)
      noisy.push_back(fmt::format("{} ({:.2g})", context.targets[k].name, sd / context.targets[k].sigma));
  }
  std::string words =
      fmt::format("measured on {} seeds; largest seed sd / sigma = {:.3g}", seeds, largest);
  if (!noisy.empty())
    words += fmt::format("; one packing scatters more than the measurement in {} of {} targets: {}",
                         noisy.size(), context.fitted.size(), list_of(noisy));
  return {"noise floor", true, words};
}

Gate reachability_gate(const FitContext& context) {
  std::vector<std::string> out;
  std::size_t unknown = 0;
  for (const std::size_t k : context.fitted) {
    TargetResult reach;
    set_reachability(context, k, reach);
    unknown += reach.reachability == Reachability::unknown ? 1 : 0;
    if (reach.reachability == Reachability::unreachable)
      out.push_back(fmt::format("{} ({:.1f} sigma)", context.targets[k].name, reach.reach_gap));
  }
  const std::size_t n = context.fitted.size();
  if (unknown > 0)
    return {"reachability", false, fmt::format("not known: too few of the design's {} runs completed", context.points.size())};
  if (out.empty())
    return {"reachability", true,
            fmt::format("all {} targets lie within 2 sigma of what the design runs reached", n)};
  return {"reachability", false,
          fmt::format("{} of {} targets lie outside of all design runs: {}", out.size(), n, list_of(out))};
}

}  // namespace

Gate determination_gate(const FitContext& context) {
  std::vector<std::string> names;
  for (const std::size_t i : context.free) names.push_back(context.parameters[i].name);
  const FitSummary& s = context.summary;
  if (s.num_free <= s.num_independent)
    return {"under-determination", true,
            fmt::format("{} free parameters, {} independent observations", s.num_free, s.num_independent)};
  return {"under-determination", false,
          fmt::format("{} free parameters ({}) but only {} independent observations, priors included: hold "
                      "some parameters, give priors, add targets, or set force",
                      s.num_free, fmt::join(names, ", "), s.num_independent)};
}

void judge_gates(FitContext& context) {
  context.summary.gates = {noise_gate(context), reachability_gate(context), determination_gate(context)};
  if (!context.options.report_gate) return;
  for (const Gate& gate : context.summary.gates) context.options.report_gate(gate);
}

}  // namespace tilth
