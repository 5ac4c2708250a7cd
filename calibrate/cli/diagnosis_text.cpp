// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calibrate/cli/diagnosis_report.hpp"
#include "calibrate/diagnosis/gap_location.hpp"
#include "calibrate/diagnosis/gap_size.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

/// "0.31 [0.25, 0.37] in loamy_sand" for every soil.
std::string sizes_text(const NamedEffect& e, const std::vector<SoilDiagnosis>& soils) {
  std::string text;
  for (std::size_t s = 0; s < e.sizes.size() && s < soils.size(); ++s)
    text += fmt::format("{}{:.3g} [{:.3g}, {:.3g}]{}", s ? ", " : "", e.sizes[s].value, e.sizes[s].lo90, e.sizes[s].hi90,
                        soils.size() > 1 ? " in " + soils[s].soil : "");
  return text;
}

std::string closure_text(const std::vector<SoilCase>& soils, std::size_t model, bool holdout) {
  const auto before = overall_gap(soils, 0, holdout), after = overall_gap(soils, model, holdout);
  if (!before || !after) return "";
  const auto closed = closure(*before, *after);
  return fmt::format("{} -> {}{}", percent(*before), percent(*after),
                     closed ? fmt::format(" ({:.0f} % closed)", 100 * *closed) : " (there was no gap to close)");
}

void add_models(const DiagnosisResult& r, std::string& text) {
  if (r.soils.empty() || r.soils.front().models.empty()) return;
  text += "\n[[Gap before and after]] root mean square disagreement beyond noise, all models refitted to the same packings\n";
  text += fmt::format("  {:<44} {:<30} {:<30}\n", "model", "fitted data", "held-out data");
  for (std::size_t m = 0; m < r.soils.front().models.size(); ++m) {
    const RefittedModel& model = r.soils.front().models[m];
    const std::string name = m == 0 ? "baseline" : "with " + fmt::format("{}", fmt::join(model.effects, " and "));
    const bool all_usable = std::ranges::all_of(r.soils, [m](const SoilCase& s) { return s.models[m].refit.is_usable; });
    if (!all_usable) {
      text += fmt::format("  {:<44} could not be simulated\n", name);
      continue;
    }
    const auto fitted = overall_gap(r.soils, m, false), held = overall_gap(r.soils, m, true);
    text += fmt::format("  {:<44} {:<30} {:<30}\n", name,
                        m == 0 ? (fitted ? percent(*fitted) : "-") : closure_text(r.soils, m, false),
                        m == 0 ? (held ? percent(*held) : "nothing is held out") : closure_text(r.soils, m, true));
  }
  text += "  Fitted data are no evidence: any further parameter closes some of that gap. Held-out data took no part in fit or choice.\n";
  for (const SoilCase& s : r.soils) {
    if (s.models.size() < 2 || !s.models[1].refit.is_usable || !s.models[0].refit.is_usable) continue;
    text += fmt::format("\n[[By experiment]] {}: baseline and with {}\n", s.campaign.means.id,
                        fmt::join(s.models[1].effects, " and "));
    for (std::size_t g = 0; g < s.models[0].gaps.size(); ++g) {
      const ExperimentGap &before = s.models[0].gaps[g], &after = s.models[1].gaps[g];
      if (before.experiment.empty()) continue;
      text += fmt::format("  {:<26} {:<9} {:>2} numbers  {:>5} -> {:>5}{}\n", before.experiment,
                          before.holdout ? "held out" : "fitted", before.num_statistics, percent(before.gap),
                          percent(after.gap), after.gap > before.gap + 0.005 ? "   worse" : "");
    }
  }
}

void add_where(const SoilCase& s, std::string& text) {
  const AnalysedSoil a = analysed(s.evidence);
  const Eigen::MatrixXd v = a.noise.total();
  const Eigen::VectorXd z = standardised_residuals(s.evidence.model, a.residual, v);
  text += fmt::format("\n[[Where]] {}: measured minus simulated by the best baseline, over its own noise\n", s.campaign.means.id);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    text += fmt::format("  {:<66} {:>+8.1f} %  {:>6}{}\n", s.evidence.model.statistics[static_cast<std::size_t>(i)].name,
                        100 * a.residual[i] / s.campaign.scale[s.fitted[static_cast<std::size_t>(i)]],
                        std::isfinite(z[i]) ? fmt::format("{:+.1f}", z[i]) : "forced",
                        std::abs(z[i]) > 3 ? "  <- disagrees" : "");
  text += "  an experiment against a baseline fitted to all others:\n";
  for (const LeftOutExperiment& e : left_out_experiments(s.evidence.model, a.residual, v))
    if (e.freedom > 0)
      text += fmt::format("    {:<26} chi-square {:>6.1f} for {:.0f}, chance {:.2g}\n", e.experiment, e.statistic, e.freedom,
                          e.tail_probability);
  bool any = false;
  for (const TugOfWar& t : tugs_of_war(s.evidence.model, a.residual, v)) {
    if (t.freedom <= 0 || t.tail_probability > 0.01) continue;
    if (!any) text += "  experiments that want different parameters:\n";
    any = true;
    text += fmt::format("    {} against {}: {:.1f} for {:.0f}, chance {:.2g}\n", t.first, t.second, t.statistic, t.freedom,
                        t.tail_probability);
  }
}

void add_ranking(const DiagnosisResult& r, std::size_t at, std::string& text) {
  const SoilDiagnosis& d = r.diagnosis.soils[at];
  const SoilCase& s = r.soils[at];
  text += fmt::format("\n[[Candidates]] {}: score of every effect that these tests can show\n", d.soil);
  text += fmt::format("  {:<46} {:>6} {:>9} {:>9} {:>9} {:>6} {:>5} {:>9}  {}\n", "effect", "z", "size", "error", "typical",
                      "prob.", "kept", "visible", "decision");
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < d.scores.size(); ++k)
    if (d.scores[k].decision != EffectDecision::not_measurable) order.push_back(k);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t k) {
    return directed_score(d.scores[k].z, s.choices[k].candidate.sign);
  });
  for (const std::size_t k : order) {
    const EffectScore& e = d.scores[k];
    text += fmt::format("  {:<46} {:>+6.1f} {:>9.3g} {:>9.2g} {:>9.3g} {:>6.2f} {:>5.2f} {:>9.3g}  {}{}\n",
                        s.choices[k].candidate.id, e.z, e.expected_change, e.standard_error, s.choices[k].candidate.typical,
                        r.diagnosis.posterior.inclusion.size() > 0
                            ? r.diagnosis.posterior.inclusion[static_cast<Eigen::Index>(k)]
                            : 0.0,
                        e.kept, e.smallest_visible, to_string(e.decision),
                        e.opposite ? "; the data ask for the opposite" : "");
  }
  text += "  kept: share of the fingerprint that refitting the baseline cannot imitate; visible: size seen with a power of 80 %\n";
  std::vector<std::string> unseen;
  for (std::size_t k = 0; k < d.scores.size(); ++k)
    if (d.scores[k].decision == EffectDecision::not_measurable)
      unseen.push_back(s.choices[k].candidate.id +
                       (s.simulated.not_simulated[k].empty() ? " (its fingerprint drowns in packing noise or is absorbed)"
                                                             : " (" + s.simulated.not_simulated[k] + ")"));
  if (!unseen.empty()) text += fmt::format("  could not have been seen:\n    {}\n", fmt::join(unseen, "\n    "));
}

void add_gates(const SoilCase& s, std::string& text) {
  text += fmt::format("\n[[Numerical gates]] {}: shift of the worst statistic over its noise, limit 0.5\n", s.campaign.means.id);
  for (const NumericalGate& g : s.gates)
    text += g.is_known ? fmt::format("  {:<16} {:>5.1f} in {}  {}\n", g.id, g.largest_shift, g.statistic,
                                     g.passed() ? "passed" : "failed: the answer still depends on it")
                       : fmt::format("  {:<16} could not be simulated\n", g.id);
}

}  // namespace

std::optional<double> overall_gap(const std::vector<SoilCase>& soils, std::size_t model, bool holdout) {
  double squares = 0.0, num = 0.0;
  for (const SoilCase& s : soils) {
    if (model >= s.models.size()) return std::nullopt;
    for (const ExperimentGap& g : s.models[model].gaps)
      if (g.experiment.empty() && g.holdout == holdout) {
        squares += g.num_statistics * g.gap * g.gap;
        num += g.num_statistics;
      }
  }
  if (num == 0.0) return std::nullopt;
  return std::sqrt(squares / num);
}

std::string verdict_sentence(const DiagnosisResult& r) {
  const Diagnosis& d = r.diagnosis;
  std::vector<std::string> names;
  for (const NamedEffect& e : d.effects)
    names.push_back(fmt::format("{} (probability {:.2f}; size {})", e.id, e.posterior, sizes_text(e, d.soils)));
  switch (d.verdict) {
    case Verdict::named: return fmt::format("named: the model lacks {}", fmt::join(names, " and "));
    case Verdict::suggested: return fmt::format("suggested: the model may lack {}; {}", fmt::join(names, " and "), d.reason);
    case Verdict::set:
      return fmt::format("set: these data cannot tell which of {}{}{} is missing", fmt::join(d.set, ", "),
                         d.set_holds_none ? ", or nothing," : "", d.set_holds_other ? ", or something outside the catalogue," : "");
    case Verdict::none: {
      std::size_t seen = 0, all = 0;
      for (const SoilDiagnosis& soil : d.soils) {
        all += soil.scores.size();
        seen += static_cast<std::size_t>(std::ranges::count(soil.scores, EffectDecision::absent, &EffectScore::decision));
      }
      return fmt::format("none: no gap larger than the noise; {} of {} candidates would have been seen at their typical size", seen, all);
    }
    case Verdict::outside_catalogue:
      return "outside_catalogue: the residual is not noise, and none of the known effects explains it";
    case Verdict::inconclusive: break;
  }
  return "inconclusive: " + d.reason;
}

std::string diagnosis_text(const DiagnosisResult& r, const DiagnosisContext& context) {
  std::string text = verdict_sentence(r) + "\n";
  if (context.preview) text += "PREVIEW (--quick): small, fast specimens; for print use the full diagnosis\n";
  text += context.provenance_sentence + "\n";
  const Diagnosis& d = r.diagnosis;
  if (d.posterior.inclusion.size() > 0)
    text += fmt::format("probabilities: nothing missing {:.2f}, outside the catalogue {:.2f}; reason: {}\n", d.posterior.none,
                        d.posterior.other, d.reason);
  for (const NamedEffect& e : d.effects)
    text += fmt::format("{}: supported by {} independent experiment{}; leads in {} of resampled data\n", e.id,
                        e.num_supporting_experiments, e.num_supporting_experiments == 1 ? "" : "s",
                        std::isfinite(e.stability) ? percent(e.stability) : "an unknown share");
  for (const SoilCase& s : r.soils) {
    for (const std::string& remark : s.remarks) text += fmt::format("{}: {}\n", s.campaign.means.id, remark);
    if (!s.failure.empty()) text += fmt::format("{}: {}\n", s.campaign.means.id, s.failure);
  }
  if (!r.advice.empty()) {
    text += "\n[[Next experiment]] least separation of the contenders, 5.4 tells them apart in 95 % of cases\n";
    for (const ExperimentAdvice& a : r.advice)
      text += fmt::format("  {:<26} {:>6.2f} -> {:>6.2f}; right order {:.0f} % -> {:.0f} %\n", a.name, a.separation_before,
                          a.separation_after, 100 * a.ordering_before, 100 * a.ordering_after);
  }
  add_models(r, text);
  for (std::size_t s = 0; s < r.soils.size(); ++s) {
    if (s >= d.soils.size()) break;  // no evidence, no statistics
    text += fmt::format("\n[[Detection]] {}: chi-square {:.1f} for {:.0f} degrees of freedom, chance {:.2g}{}\n", d.soils[s].soil,
                        d.soils[s].gap.chi_square, d.soils[s].gap.nu, d.soils[s].gap.tail_probability,
                        std::isfinite(d.soils[s].bootstrap_tail) ? fmt::format(" (bootstrap {:.2g})", d.soils[s].bootstrap_tail) : "");
    add_where(r.soils[s], text);
    add_ranking(r, s, text);
    add_gates(r.soils[s], text);
  }
  text += "\n[[Baseline]]\n";
  for (const SoilCase& s : r.soils) {
    if (s.unit.size() == 0) continue;
    const Eigen::VectorXd values = with_ties(s.campaign.means.parameters, physical_point(s.parameters, s.unit));
    for (const std::size_t j : free_parameters(s.parameters))
      text += fmt::format("  {} {} = {:.4g}\n", s.campaign.means.id, s.parameters[j].name, values[static_cast<Eigen::Index>(j)]);
  }
  return text + fmt::format("\n{} simulations, {} failed\nreproduce: {}\n", context.num_simulations, context.num_failed,
                            context.command);
}

}  // namespace tilth
