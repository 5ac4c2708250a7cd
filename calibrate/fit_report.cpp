// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calibrate/fit_report_sections.hpp"

namespace tilth {
namespace {

bool has_stage(const FitSummary& s, const char* name) {
  return std::ranges::find(s.stages, name, &StageCount::stage) != s.stages.end();
}

void what_error_bars_mean(const FitSummary& s, std::string& text) {
  if (s.sigma_is_rescaled) {
    report_line(text, "sigma: rescaled by reduced chi-square (standard errors times {:.6g})",
                s.sigma_scale);
    report_line(text, "error bars: standard errors, linear; intervals +/- {:.4f} of them",
                s.interval_factor);
    report_line(text, "(95 %, Student's t with {} degrees of freedom), clipped at the bounds",
                s.degrees_of_freedom);
  } else {
    report_line(text, "sigma: absolute; nothing is rescaled by reduced chi-square");
    report_line(
        text, "error bars: standard errors, linear and normal; intervals +/- 1.96 of them (95 %),");
    report_line(text, "taken in ln(value) on log scales, clipped at the bounds");
  }
  if (s.profiles.empty()) return report_line(text, "profiles: none");
  report_line(text, "profiles: 95 % where chi-square rises by {:.4g} with all others refitted;",
              s.profile_level);
  report_line(text, "drawn on {}", s.profile_source);
  report_line(text, "equivalence family: {} parameter sets within that rise, in fit.json",
              s.equivalence_family.size());
}

void fit_statistics(const FitSummary& s, std::string& text) {
  text += "[[Fit Statistics]]\n";
  const double k = static_cast<double>(s.num_free);
  const double n = static_cast<double>(s.num_observations);
  report_line(text, "# ended               = {}: {}", to_string(s.termination), s.message);
  report_line(text, "# method              = {}Levenberg-Marquardt (Ceres)",
              has_stage(s, "search") ? "Sobol design, emulator with NLopt, " : "");
  report_line(text, "# function evals      = {} ({} failed)", s.num_simulations, s.failures.size());
  for (const StageCount& stage : s.stages) {
    if (stage.num_completed + stage.num_failed == 0) continue;
    report_line(text, "#   {:<17} = {} ({} failed)", stage.stage,
                stage.num_completed + stage.num_failed, stage.num_failed);
  }
  report_line(text, "# data points         = {} (independent: {})", s.num_observations,
              s.num_independent);
  report_line(text, "# variables           = {}", s.num_free);
  report_line(text, "chi-square at start   = {} (one packing)", report_number(s.chi_square_start));
  report_line(text, "chi-square            = {}", report_number(s.chi_square));
  report_line(text, "chi-square, new seeds = {} ({} seeds)", report_number(s.chi_square_fresh),
              s.num_fresh_seeds);
  report_line(
      text, "reduced chi-square    = {}",
      n > k ? report_number(s.chi_square / (n - k)) : std::string("- (no degrees of freedom)"));
  report_line(text, "AIC = chi2 + 2 k      = {}", report_number(s.chi_square + 2.0 * k));
  report_line(text, "BIC = chi2 + k ln n   = {}", report_number(s.chi_square + k * std::log(n)));
  report_line(text, "R-squared             = {}",
              std::isnan(s.r_squared) ? std::string("- (the targets have different units)")
                                      : report_number(s.r_squared));
  report_line(text, "best value found {} times of {} starts", s.num_starts_at_best, s.num_starts);
  what_error_bars_mean(s, text);
  report_line(text, "effective sample size of simulated - measured, per curve{}",
              s.sample_sizes.empty() ? ": - (no measured curve was compared)" : ":");
  for (const CurveSampleSize& curve : s.sample_sizes) {
    report_line(text, "effective sample size of {}: {:.1f} of {} points", curve.curve,
                curve.effective, curve.num_points);
  }
}

void gates(const FitSummary& s, std::string& text) {
  text += "[[Gates]]\n";
  for (const Gate& gate : s.gates)
    report_line(text, "{:<19}: {} ({})", gate.name, gate.passed ? "passed" : "failed", gate.words);
  const auto unreachable =
      std::ranges::count(s.targets, Reachability::unreachable, &TargetResult::reachability);
  report_line(text, "after the search   : {} of {} targets unreachable", unreachable, s.targets.size());
  if (std::isnan(s.holdout_rms)) {
    report_line(text, "hold-out           : {}",
                s.holdouts.empty() ? "not tested (no hold-out targets)" : "failed (not predicted)");
  } else {
    report_line(text, "hold-out           : {} (rms residual {:.3g}, pass mark {:.3g})",
                s.holdout_failed() ? "failed" : "passed", s.holdout_rms, s.holdout_limit);
  }
}

void warnings(const FitSummary& s, std::string& text) {
  text += "[[Warnings]]\n";
  for (const std::string& warning : s.warnings) report_line(text, "{}", warning);
  if (!s.failures.empty()) {
    report_line(text, "{} failed runs, the first: {} (stage {}, seed {})", s.failures.size(),
                s.failures.front().message, s.failures.front().stage, s.failures.front().seed);
  }
  if (s.warnings.empty() && s.failures.empty()) report_line(text, "none");
}

// Why a target is out of reach, with the number.
std::string reach_words(const TargetResult& t) {
  if (!t.conflicts_with.empty())
    return fmt::format("  (with {}: {} sigma at best)", t.conflicts_with,
                       short_report_number(t.joint_misfit));
  if (t.reachability == Reachability::unreachable)
    return fmt::format("  (nearest run {} sigma off)", short_report_number(t.reach_gap));
  return "";
}

void target_table(const std::vector<TargetResult>& targets, const char* title, std::string& text) {
  text += title;
  std::size_t width = 6;
  for (const TargetResult& target : targets) width = std::max(width, target.name.size());
  if (targets.empty()) return report_line(text, "none");
  report_line(text, "{:<{}} {:<10} {:>11} {:>9} {:>11} {:>9} {:>9}  {}", "target", width,
              "provenance", "value", "sigma", "simulated", "seed sd", "residual", "reachability");
  for (const TargetResult& t : targets) {
    report_line(text, "{:<{}} {:<10} {:>11} {:>9} {:>11} {:>9} {:>9}  {}{}", t.name, width,
                to_string(t.provenance), report_number(t.value), short_report_number(t.sigma),
                report_number(t.simulated), short_report_number(t.seed_sd),
                short_report_number(t.residual), to_string(t.reachability),
                reach_words(t) + (t.log_transform ? "  (sigma and seed sd of ln)" : ""));
  }
}

void conflict_table(const FitSummary& s, std::string& text) {
  text += fmt::format(
      "[[Conflicts]] (can be met alone but not together: no parameter set brings both "
      "within {:.1f} total sigma; on emulators)\n",
      conflict_limit);
  constexpr std::size_t most = 12;
  for (std::size_t k = 0; k < std::min(most, s.conflicts.size()); ++k) {
    const TargetConflict& c = s.conflicts[k];
    report_line(text, "{} and {}: {} sigma at best", c.first, c.second,
                short_report_number(c.misfit));
  }
  if (s.conflicts.size() > most) report_line(text, "and {} more pairs", s.conflicts.size() - most);
  if (s.conflicts.empty()) report_line(text, "none found");
}

void bias_table(const FitSummary& s, std::string& text) {
  text += "[[Bias]] (confirming minus search simulator, in the transformed quantity)\n";
  if (s.num_bias_rounds == 0) return report_line(text, "not measured: no confirming simulator");
  for (const TargetResult& t : s.targets) {
    report_line(text, "{}: {:+.4g} +/- {}{}", t.name, t.bias, short_report_number(t.bias_error),
                t.log_transform ? " (of ln)" : "");
  }
  report_line(text, "{} round(s); the last one moved the parameters by {} standard errors at most",
              s.num_bias_rounds, short_report_number(s.last_bias_shift));
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
  report_variables(summary, text);
  report_correlations(summary, text);
  report_null_directions(summary, text);
  target_table(summary.targets, "[[Targets]]\n", text);
  conflict_table(summary, text);
  bias_table(summary, text);
  target_table(summary.holdouts, "[[Hold-out]] (predicted, never fitted)\n", text);
  return text;
}

}  // namespace tilth
