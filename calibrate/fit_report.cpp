// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/fit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <vector>

namespace tilth {
namespace {

constexpr double smallest_reported_correlation = 0.1;

using Out = std::back_insert_iterator<std::string>;

template <typename... Arguments>
void line(std::string& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  text += "    ";
  fmt::format_to(Out(text), format, std::forward<Arguments>(arguments)...);
  text += '\n';
}

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.6g}", value); }
std::string short_number(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

void fit_statistics(const FitSummary& s, std::string& text) {
  text += "[[Fit Statistics]]\n";
  const double k = static_cast<double>(s.num_free);
  const double n = static_cast<double>(s.num_observations);
  line(text, "# ended               = {}: {}", to_string(s.termination), s.message);
  line(text,
       "# method              = Sobol design, emulator with NLopt, Levenberg-Marquardt (Ceres)");
  line(text, "# function evals      = {} ({} failed)", s.num_simulations, s.failures.size());
  for (const StageCount& stage : s.stages) {
    if (stage.num_completed + stage.num_failed == 0) continue;
    line(text, "#   {:<17} = {} ({} failed)", stage.stage, stage.num_completed + stage.num_failed,
         stage.num_failed);
  }
  line(text, "# data points         = {} (independent: {})", s.num_observations, s.num_independent);
  line(text, "# variables           = {}", s.num_free);
  line(text, "chi-square at start   = {}", number(s.chi_square_start));
  line(text, "chi-square            = {}", number(s.chi_square));
  line(text, "chi-square, new seeds = {} ({} seeds)", number(s.chi_square_fresh),
       s.num_fresh_seeds);
  line(text, "reduced chi-square    = {}",
       n > k ? number(s.chi_square / (n - k)) : std::string("- (no degrees of freedom)"));
  line(text, "AIC = chi2 + 2 k      = {}", number(s.chi_square + 2.0 * k));
  line(text, "BIC = chi2 + k ln n   = {}", number(s.chi_square + k * std::log(n)));
  line(text, "R-squared             = - (the targets have different units)");
  line(text, "best value found {} times of {} starts", s.num_starts_at_best, s.num_starts);
  line(text, "sigma: absolute; nothing is rescaled by reduced chi-square");
  line(text, "error bars: standard errors, linear and normal; intervals +/- 1.96 of them (95 %),");
  line(text, "taken in ln(value) on log scales, clipped at the bounds");
}

void noise_gate(const FitSummary& s, std::string& text) {
  double largest = 0.0;
  for (const TargetResult& target : s.targets) {
    largest = std::max(largest, target.seed_sd / target.sigma);
  }
  if (s.num_noise_seeds < 2) {
    line(text, "noise floor        : failed (not measured: {} repeat seeds)", s.num_noise_seeds);
  } else {
    line(text,
         "noise floor        : passed (measured on {} seeds; largest seed sd / sigma = {:.3g})",
         s.num_noise_seeds, largest);
  }
}

void gates(const FitSummary& s, std::string& text) {
  text += "[[Gates]]\n";
  noise_gate(s, text);
  int unreachable = 0;
  int unknown = 0;
  for (const TargetResult& target : s.targets) {
    unreachable += target.reachability == Reachability::unreachable ? 1 : 0;
    unknown += target.reachability == Reachability::unknown ? 1 : 0;
  }
  line(text, "reachability       : {} ({} of {} targets unreachable, {} unknown)",
       unreachable == 0 && unknown == 0 ? "passed" : "failed", unreachable, s.targets.size(),
       unknown);
  line(text, "under-determination: {} ({} free parameters, {} independent observations)",
       s.num_free <= s.num_independent ? "passed" : "failed", s.num_free, s.num_independent);
  if (std::isnan(s.holdout_rms)) {
    line(text, "hold-out           : {}",
         s.holdouts.empty() ? "not tested (no hold-out targets)" : "failed (not predicted)");
  } else {
    line(text, "hold-out           : {} (rms residual {:.3g}, pass mark {:.3g})",
         s.holdout_failed() ? "failed" : "passed", s.holdout_rms, s.holdout_limit);
  }
}

void warnings(const FitSummary& s, std::string& text) {
  text += "[[Warnings]]\n";
  for (const std::string& warning : s.warnings) line(text, "{}", warning);
  if (!s.failures.empty()) {
    line(text, "{} failed runs, the first: {} (stage {}, seed {})", s.failures.size(),
         s.failures.front().message, s.failures.front().stage, s.failures.front().seed);
  }
  if (s.warnings.empty() && s.failures.empty()) line(text, "none");
}

std::string error_words(const FittedParameter& p) {
  if (!p.no_error_bar.empty()) return fmt::format("no error bar because {}", p.no_error_bar);
  // Standard error in the physical unit; on a log scale that of the tangent, value * se.
  const double error = p.log_scale ? p.value * p.standard_error : p.standard_error;
  const std::string percent =
      p.value != 0.0 ? fmt::format(" ({:.2f}%)", 100.0 * error / std::abs(p.value)) : "";
  return fmt::format("+/- {}{}  95 % [{}, {}]", short_number(error), percent, number(p.lo95),
                     number(p.hi95));
}

void variables(const FitSummary& s, std::string& text) {
  text += "[[Variables]]\n";
  std::size_t width = 0;
  for (const FittedParameter& p : s.parameters) width = std::max(width, p.name.size());
  for (const FittedParameter& p : s.parameters) {
    if (!p.expression.empty()) {
      line(text, "{:<{}} {} == '{}'", p.name + ":", width + 1, number(p.value), p.expression);
    } else if (p.verdict == ParameterVerdict::fixed) {
      line(text, "{:<{}} {} (fixed)", p.name + ":", width + 1, number(p.value));
    } else {
      line(text, "{:<{}} {} {} (init = {})  {}", p.name + ":", width + 1, number(p.value),
           error_words(p), number(p.start), to_string(p.verdict));
    }
  }
}

void correlations(const FitSummary& s, std::string& text) {
  text += fmt::format("[[Correlations]] (unreported correlations are < {:.3f})\n",
                      smallest_reported_correlation);
  std::vector<const FittedParameter*> free;
  for (const FittedParameter& p : s.parameters) {
    if (p.estimate) free.push_back(&p);
  }
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (Eigen::Index i = 0; i < s.correlation.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < s.correlation.cols(); ++j) {
      const double c = s.correlation(i, j);
      if (std::abs(c) >= smallest_reported_correlation) {
        pairs.emplace_back(c, static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      }
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return std::abs(std::get<0>(a)) > std::abs(std::get<0>(b));
  });
  for (const auto& [c, i, j] : pairs) {
    line(text, "C({}, {}) = {:+.4f}", free[i]->name, free[j]->name, c);
  }
  if (s.covariance.size() == 0) line(text, "not known: there is no covariance");
}

void null_directions(const FitSummary& s, std::string& text) {
  text += "[[Null directions]]\n";
  for (const std::string& words : s.null_directions) line(text, "{}", words);
  if (s.null_directions.empty()) {
    line(text, "{}", s.covariance.size() == 0 ? "not known: there is no covariance" : "none");
  }
}

// Why a target is out of reach, with the number.
std::string reach_words(const TargetResult& t) {
  if (!t.conflicts_with.empty())
    return fmt::format("  (with {}: {} sigma at best)", t.conflicts_with,
                       short_number(t.joint_misfit));
  if (t.reachability == Reachability::unreachable)
    return fmt::format("  (nearest run {} sigma off)", short_number(t.reach_gap));
  return "";
}

void target_table(const std::vector<TargetResult>& targets, const char* title, std::string& text) {
  text += title;
  std::size_t width = 6;
  for (const TargetResult& target : targets) width = std::max(width, target.name.size());
  if (targets.empty()) return line(text, "none");
  line(text, "{:<{}} {:<10} {:>11} {:>9} {:>11} {:>9} {:>9}  {}", "target", width, "provenance",
       "value", "sigma", "simulated", "seed sd", "residual", "reachability");
  for (const TargetResult& t : targets) {
    line(text, "{:<{}} {:<10} {:>11} {:>9} {:>11} {:>9} {:>9}  {}{}", t.name, width,
         to_string(t.provenance), number(t.value), short_number(t.sigma), number(t.simulated),
         short_number(t.seed_sd), short_number(t.residual), to_string(t.reachability),
         reach_words(t) + (t.log_transform ? "  (sigma and seed sd of ln)" : ""));
  }
}

void conflict_table(const FitSummary& s, std::string& text) {
  text += fmt::format("[[Conflicts]] (can be met alone but not together: no parameter set brings both "
                      "within {:.1f} total sigma; on emulators)\n",
                      conflict_limit);
  constexpr std::size_t most = 12;
  for (std::size_t k = 0; k < std::min(most, s.conflicts.size()); ++k) {
    const TargetConflict& c = s.conflicts[k];
    line(text, "{} and {}: {} sigma at best", c.first, c.second, short_number(c.misfit));
  }
  if (s.conflicts.size() > most) line(text, "and {} more pairs", s.conflicts.size() - most);
  if (s.conflicts.empty()) line(text, "none found");
}

void bias_table(const FitSummary& s, std::string& text) {
  text += "[[Bias]] (confirming minus search simulator, in the transformed quantity)\n";
  if (s.num_bias_rounds == 0) return line(text, "not measured: no confirming simulator");
  for (const TargetResult& t : s.targets) {
    line(text, "{}: {:+.4g} +/- {}{}", t.name, t.bias, short_number(t.bias_error),
         t.log_transform ? " (of ln)" : "");
  }
  line(text, "{} round(s); the last one moved the parameters by {} standard errors at most",
       s.num_bias_rounds, short_number(s.last_bias_shift));
}

}  // namespace

std::string fit_report_text(const FitSummary& summary, const ReportContext& context) {
  std::string text = context.first_line + "\n";
  if (summary.parameters.empty()) {  // nothing was run
    return text + fmt::format("{}: {}\n", to_string(summary.termination), summary.message);
  }
  fit_statistics(summary, text);
  gates(summary, text);
  warnings(summary, text);
  variables(summary, text);
  correlations(summary, text);
  null_directions(summary, text);
  target_table(summary.targets, "[[Targets]]\n", text);
  conflict_table(summary, text);
  bias_table(summary, text);
  target_table(summary.holdouts, "[[Hold-out]] (predicted, never fitted)\n", text);
  return text;
}

}  // namespace tilth
