// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/sensitivity_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tilth {
namespace {

constexpr double wide_interval = 0.2;   // of S or ST: the estimate says little
constexpr double low_q2 = 0.7;          // below it an emulator is no stand-in
constexpr std::size_t num_reasons = 5;  // most frequent ones

std::string number(double v) { return std::isfinite(v) ? fmt::format("{:.3g}", v) : "-"; }
std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.3g} %", 100.0 * share) : "-";
}

std::string with_interval(const IndexEstimate& i) {
  const bool is_bounded = std::isfinite(i.bound_low);
  return fmt::format(
      "{:>8} [{}, {}]{}", number(i.value), number(i.low95), number(i.high95),
      is_bounded ? fmt::format(" {{{}, {}}}", number(i.bound_low), number(i.bound_high)) : "");
}

// What a failure says up to its numbers: reasons that differ in them only are one.
std::string reason_of(const std::string& message) {
  return message.substr(0, message.find_first_of("0123456789"));
}

void append_reasons(const SensitivitySummary& s, std::string& text) {
  std::map<std::string, int> counts;
  for (const SampleRun& run : s.runs)
    if (run.has_failed() && !run.is_known) ++counts[reason_of(run.evaluation.message)];
  std::vector<std::pair<int, std::string>> reasons;
  for (const auto& [reason, count] : counts) reasons.emplace_back(-count, reason);
  std::ranges::sort(reasons);
  for (std::size_t k = 0; k < std::min(num_reasons, reasons.size()); ++k)
    text += fmt::format("      {} x {}...\n", -reasons[k].first, reasons[k].second);
}

std::string verdict_sentence(FailureVerdict verdict) {
  switch (verdict) {
    case FailureVerdict::none:
      return "";
    case FailureVerdict::no_pattern:
      return "; no dependence on a parameter seen: estimates on the completed runs stand";
    case FailureVerdict::too_few:
      return "; too few to see a pattern: {bounds} say what they could change";
    case FailureVerdict::concentrated:
      return "; CONCENTRATED: estimates are of the other runs; {bounds} say what it could change";
  }
  return "";
}

bool is_same(const FailurePattern& a, const FailurePattern& b) {
  const auto same_parameter = [](const ParameterFailures& x, const ParameterFailures& y) {
    return x.p_value == y.p_value;
  };
  return a.num_failed == b.num_failed &&
         std::ranges::equal(a.parameters, b.parameters, same_parameter);
}

// `before`: the feature above, whose table is not printed twice.
void append_failures(const SensitivitySummary& s, const FailurePattern& p,
                     const FailurePattern* before, std::string& text) {
  text += fmt::format("    failed        : {} of {} ({}){}\n", p.num_failed, p.num_runs,
                      percent(p.share()), verdict_sentence(p.verdict));
  if (before && p.num_failed > 0 && is_same(p, *before)) {
    text += "      the same runs as above\n";
    return;
  }
  for (std::size_t j = 0; j < p.parameters.size(); ++j) {
    const ParameterFailures& f = p.parameters[j];
    text += fmt::format("      {:<28} p = {:<8} low third {}, middle {}, high {}\n",
                        s.free_names[j], number(f.p_value), percent(f.shares[0]),
                        percent(f.shares[1]), percent(f.shares[2]));
  }
}

void append_table(const SensitivitySummary& s, const FeatureSensitivity& f,
                  const std::vector<IndexKind>& kinds, std::string& text) {
  std::vector<std::string> lines(s.free_names.size() + 1, "    parameter");
  for (std::size_t j = 0; j < s.free_names.size(); ++j) lines[j + 1] = "    " + s.free_names[j];
  for (const IndexKind kind : kinds) {
    std::size_t width = 0;
    for (const std::string& line : lines) width = std::max(width, line.size());
    for (std::string& line : lines) line.resize(width + 2, ' ');
    lines[0] += fmt::format("{:>8}", to_string(kind));
    for (const IndexEstimate& i : f.indices)
      if (i.kind == kind) lines[i.parameter + 1] += with_interval(i);
  }
  for (const std::string& line : lines) text += line + "\n";
}

void append_pairs(const SensitivitySummary& s, const FeatureSensitivity& f, std::string& text) {
  for (const IndexEstimate& i : f.indices)
    if (i.kind == IndexKind::second_order)
      text += fmt::format("    Sij {} x {} {}\n", s.free_names[i.parameter], s.free_names[i.other],
                          with_interval(i));
}

void append_emulator(const FeatureSensitivity& f, std::string& text) {
  text += fmt::format(
      "    emulator      : leave-one-out q2 = {}, root mean square error {}{}\n",
      number(f.emulator.q2), number(f.emulator.rms),
      f.emulator.q2 >= low_q2 ? "" : fmt::format("; below {}: do not trust these indices", low_q2));
  text += "    intervals     : of the integration only; the emulator's own error is not in them\n";
}

void append_feature(const SensitivitySummary& s, std::size_t feature, std::string& text) {
  const FeatureSensitivity& f = s.features[feature];
  const bool is_morris = s.options.method == SensitivityMethod::morris;
  const bool is_emulated = s.options.method == SensitivityMethod::emulator;
  text += fmt::format("\n[[{}]]{}{}\n", f.name, is_emulated ? "   EMULATOR" : "",
                      f.holdout ? "   held out of fits" : "");
  text += fmt::format("    scale         : {}\n", f.log_transform ? "ln(value)" : "value, SI unit");
  append_failures(s, f.failures, feature > 0 ? &s.features[feature - 1].failures : nullptr, text);
  text += fmt::format("    packing noise : {}\n", noise_sentence(f));
  if (is_emulated) append_emulator(f, text);
  if (!f.no_indices.empty()) {
    text += fmt::format("    no indices    : {}\n", f.no_indices);
    return;
  }
  if (is_morris) {
    text += fmt::format("    mu_star of a parameter without effect (packing noise): {}\n",
                        number(f.noise_floor));
    append_table(s, f, {IndexKind::mu_star, IndexKind::mu, IndexKind::sigma}, text);
    return;
  }
  append_table(s, f, {IndexKind::first_order, IndexKind::total}, text);
  append_pairs(s, f, text);
}

}  // namespace

std::string preview_sentence(const SensitivityContext& context) {
  return context.preview
             ? "PREVIEW (--quick): small, fast specimens and few samples; do not publish these "
               "numbers"
             : "";
}

std::string method_sentence(const SensitivitySummary& s) {
  const std::size_t d = s.free_names.size();
  switch (s.options.method) {
    case SensitivityMethod::morris:
      return fmt::format("Morris, {} levels (ranks depend on them), {} trajectories of {} points",
                         s.options.levels, s.num_rows, d + 1);
    case SensitivityMethod::sobol:
      return fmt::format("Sobol, {} rows of {} points", s.num_rows, 2 * d + 2);
    case SensitivityMethod::emulator:
      return fmt::format("Sobol by EMULATOR of {} points: indices of a stand-in, not of the model",
                         s.num_rows);
  }
  return "";
}

std::string failure_sentence(const SensitivitySummary& s) {
  const double share =
      s.num_runs == 0 ? 0.0 : static_cast<double>(s.num_failed) / static_cast<double>(s.num_runs);
  return fmt::format("{} runs, {} failed in a test or more ({})", s.num_runs, s.num_failed,
                     percent(share));
}

std::string noise_sentence(const FeatureSensitivity& f) {
  if (std::isnan(f.noise.noise_share)) return "not measured (one packing)";
  const double noise = f.noise.shared + f.noise.independent;
  return fmt::format("{} of the variance of one run [{}, {}]; {} of it alike for all parameters",
                     percent(f.noise.noise_share), percent(f.noise_low95), percent(f.noise_high95),
                     noise > 0 ? percent(f.noise.shared / noise) : "-");
}

std::string advice(const SensitivitySummary& s) {
  const double widest = s.widest_interval();
  if (s.options.method != SensitivityMethod::sobol || !(widest > wide_interval)) return "";
  return fmt::format(
      "{} rows are few: the widest interval of S or ST is {:.2g}. --extend doubles them; "
      "--emulator "
      "estimates the indices from single points of the same design, at 1/{} of the runs per sample "
      "and with an error of its own that is printed.",
      s.num_rows, widest, 2 * s.free_names.size() + 2);
}

std::string sensitivity_report_text(const SensitivitySummary& s,
                                    const SensitivityContext& context) {
  std::string text = context.preview ? preview_sentence(context) + "\n" : "";
  text += fmt::format("Sensitivity of {}: {}\n{}\n", context.subject, method_sentence(s),
                      context.provenance);
  const PackingPlan& p = s.options.packings;
  text += fmt::format(
      "packing seeds {} to {}, design seed {}; {}\n"
      "value [95 % bootstrap over rows, {} resamples] {{bounds of failed runs}}; packing noise "
      "taken out of S, ST and sigma\n",
      p.first_seed, p.first_seed + static_cast<std::uint64_t>(p.num_packings) - 1, p.first_seed,
      s.options.method == SensitivityMethod::morris
          ? "effects per unit of the unit cube"
          : "shares of the variance over the parameters' bounds",
      s.options.num_resamples);
  text += fmt::format("ended: {} after {} of {} samples; {}\n", to_string(s.end), s.num_rows,
                      s.options.num_rows, failure_sentence(s));
  append_reasons(s, text);
  for (std::size_t k = 0; k < s.features.size(); ++k) append_feature(s, k, text);
  const std::string hint = advice(s);
  return hint.empty() ? text : text + "\n" + hint + "\n";
}

}  // namespace tilth
