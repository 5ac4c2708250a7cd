// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/diagnosis_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/diagnosis/gap_size.hpp"
#include "calibrate/moderated_variances.hpp"
#include "calibrate/sobol_design.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

/// Blocks of packings; a fit of seed s uses s ... s + 2999.
enum SeedBlock : std::uint64_t { baseline_block = 1, residual_block, derivative_block, refit_block, advice_block };
constexpr std::uint64_t block_size = 10'000;

constexpr double least_packing_variance = 1e-6;  ///< of T: what does not scatter at all is still not exact
constexpr double start_range = 0.2;              ///< of the unit cube, about the nominal values: starts of the baseline
constexpr double usual_packing_cv = 0.06;        ///< while choosing a start
constexpr double cost_of_missing = 25.0;         ///< a number that a start cannot give
constexpr double converged_move = 0.005;         ///< of the unit cube
constexpr double planned_cv = 0.10;              ///< of specimens in advice, five of them
constexpr double planned_replicates = 5.0;

std::string statistic_name(const SoilTarget& t) { return t.test_id + "." + t.observable_id + "@" + t.condition_id; }

/// Specimens and packings of the wanted statistics, renumbered 0, 1, ... in the order of `rows`.
std::vector<TestSamples> samples_of(const MeasuredCampaign& campaign, const Eigen::MatrixXd& packings,
                                    const std::vector<Eigen::Index>& rows) {
  std::vector<TestSamples> samples;
  for (const MeasuredTest& test : campaign.tests) {
    TestSamples s;
    std::vector<Eigen::Index> own, all;
    for (std::size_t k = 0; k < test.statistics.size(); ++k) {
      const auto at = std::ranges::find(rows, test.statistics[k]);
      if (at == rows.end()) continue;
      s.statistics.push_back(at - rows.begin());
      own.push_back(static_cast<Eigen::Index>(k));
      all.push_back(test.statistics[k]);
    }
    if (own.empty()) continue;
    s.replicates = test.replicates(Eigen::all, own);
    s.packings = packings(Eigen::all, all);
    samples.push_back(std::move(s));
  }
  return samples;
}

/// Variance of one packing, pooled over the conditions of an observable.
Eigen::VectorXd pooled_packing_variances(const SoilData& soil, const Eigen::MatrixXd& packings) {
  const Eigen::VectorXd own = sample_variances(packings.transpose());
  std::map<std::string, std::pair<double, double>> pools;
  for (std::size_t k = 0; k < soil.targets.size(); ++k) {
    auto& [sum, num] = pools[soil.targets[k].test_id + "/" + soil.targets[k].observable_id];
    sum += own[static_cast<Eigen::Index>(k)];
    num += 1.0;
  }
  Eigen::VectorXd pooled(own.size());
  for (std::size_t k = 0; k < soil.targets.size(); ++k) {
    const auto& [sum, num] = pools[soil.targets[k].test_id + "/" + soil.targets[k].observable_id];
    pooled[static_cast<Eigen::Index>(k)] = std::max(least_packing_variance, sum / num);
  }
  return pooled;
}

NoisePriors priors_of(const MeasuredCampaign& campaign, const Eigen::MatrixXd& packings,
                      const std::vector<Eigen::Index>& rows) {
  NoisePriors priors;
  priors.replicate_variances = campaign.prior_variances(rows);
  priors.packing_variances = pooled_packing_variances(campaign.means, packings)(rows);
  return priors;
}

std::vector<Eigen::Index> all_rows(const SoilCase& soil) {
  std::vector<Eigen::Index> rows(soil.targets.size());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<Eigen::Index>(k);
  return rows;
}

Eigen::VectorXd measured_means(const SoilCase& soil) {
  Eigen::VectorXd mean(static_cast<Eigen::Index>(soil.targets.size()));
  for (std::size_t k = 0; k < soil.targets.size(); ++k)
    mean[static_cast<Eigen::Index>(k)] = transformed(soil.targets[k], soil.targets[k].value);
  return mean;
}

/// What could not be compared moves nothing.
Eigen::MatrixXd finite_or_zero(const Eigen::MatrixXd& m) { return m.array().isFinite().select(m, 0.0); }

/// A parameter at its bound cannot absorb anything: it would have to go on.
void hold_at_bounds(const SoilCase& soil, SimulatedEvidence& e, std::vector<std::string>& remarks) {
  const std::vector<std::size_t> free = free_parameters(soil.parameters);
  for (Eigen::Index j = 0; j < soil.unit.size(); ++j) {
    if (soil.unit[j] > 0.0 && soil.unit[j] < 1.0) continue;
    const Parameter& p = soil.parameters[free[static_cast<std::size_t>(j)]];
    e.jacobian.col(j).setZero();
    e.jacobian_variances.col(j).setZero();
    remarks.push_back(fmt::format("{} of the best baseline is at its bound {:g}: it is held there and absorbs nothing", p.name,
                                  soil.unit[j] > 0.0 ? p.upper : p.lower));
  }
}

/// Model near the optimum in the statistics `rows`; an effect without a whole fingerprint has a column of zeros.
LinearModel linear_model(const SoilData& soil, const SimulatedEvidence& e, const std::vector<Eigen::Index>& rows) {
  LinearModel model;
  for (const Eigen::Index k : rows) {
    const SoilTarget& t = soil.targets[static_cast<std::size_t>(k)];
    model.statistics.push_back({t.test_id, statistic_name(t)});
  }
  model.jacobian = finite_or_zero(e.jacobian)(rows, Eigen::all);
  model.jacobian_variances = finite_or_zero(e.jacobian_variances)(rows, Eigen::all);
  Eigen::MatrixXd fingerprints = e.fingerprints, variances = e.fingerprint_variances;
  for (Eigen::Index k = 0; k < fingerprints.cols(); ++k)
    if (!e.not_simulated[static_cast<std::size_t>(k)].empty()) {
      fingerprints.col(k).setZero();
      variances.col(k).setZero();
    }
  model.fingerprints = fingerprints(rows, Eigen::all);
  model.fingerprint_variances = variances(rows, Eigen::all);
  return model;
}

std::vector<NumericalGate> gates_of(const SoilCase& soil) {
  std::vector<NumericalGate> gates;
  for (std::size_t k = 0; k < soil.choices.size(); ++k) {
    const CandidateChoice& c = soil.choices[k];
    if (c.kind != EffectKind::numerical || !c.step.is_active) continue;
    NumericalGate gate{c.candidate.id, soil.simulated.not_simulated[k].empty(), 0.0, ""};
    for (const Eigen::Index i : soil.fitted) {
      const double shift = std::abs(soil.simulated.fingerprints(i, static_cast<Eigen::Index>(k)) * c.step.step()) /
                           std::sqrt(soil.covariance(i, i));
      if (gate.is_known && shift > gate.largest_shift) {
        gate.largest_shift = shift;
        gate.statistic = statistic_name(soil.campaign.means.targets[static_cast<std::size_t>(i)]);
      }
    }
    gates.push_back(gate);
  }
  return gates;
}

std::vector<ExperimentGap> gaps_of(const SoilCase& soil, const Eigen::VectorXd& residual) {
  std::vector<ExperimentGap> gaps;
  const auto add = [&](const std::string& experiment, bool holdout) {
    std::vector<double> r, v;
    for (std::size_t k = 0; k < soil.targets.size(); ++k) {
      const SoilTarget& t = soil.campaign.means.targets[k];
      if (t.holdout != holdout || (!experiment.empty() && t.test_id != experiment)) continue;
      const auto i = static_cast<Eigen::Index>(k);
      const double scale = soil.campaign.scale[i];
      r.push_back(residual[i] / scale);
      v.push_back(soil.covariance(i, i) / (scale * scale));
    }
    if (r.empty()) return;
    const auto n = static_cast<Eigen::Index>(r.size());
    gaps.push_back({experiment, holdout, static_cast<int>(r.size()),
                    gap_size(Eigen::Map<const Eigen::VectorXd>(r.data(), n), Eigen::Map<const Eigen::VectorXd>(v.data(), n))});
  };
  std::vector<std::string> experiments;
  for (const SoilTarget& t : soil.campaign.means.targets)
    if (std::ranges::find(experiments, t.test_id) == experiments.end()) experiments.push_back(t.test_id);
  experiments.emplace_back();
  for (const bool holdout : {false, true})
    for (const std::string& e : experiments) add(e, holdout);
  return gaps;
}

std::vector<EffectStep> steps_of(const SoilCase& soil) {
  std::vector<EffectStep> steps;
  for (const CandidateChoice& c : soil.choices) steps.push_back(c.step);
  return steps;
}

}  // namespace

DiagnosisSettings diagnosis_settings(bool quick, std::uint64_t seed) {
  DiagnosisSettings s;
  s.seed = seed;
  s.fidelity = quick ? Fidelity::preview : Fidelity::search;
  s.statistics.seed = seed;
  return s;
}

SoilCase soil_case(const SoilData& soil) {
  SoilCase c;
  c.campaign = measured_campaign(soil);
  add_effect_parameters(c.campaign.means);
  c.remarks = c.campaign.remarks;
  if (!c.campaign.has_replicates)
    c.remarks.push_back("nothing was repeated with scatter: the noise is the stated sigma, which no data support; a name can be suggested at most");
  c.parameters = fit_parameters(c.campaign.means);
  c.targets = fit_targets(c.campaign.means);
  c.choices = candidate_choices(c.campaign.means);
  for (std::size_t k = 0; k < c.targets.size(); ++k)
    if (!c.targets[k].holdout) c.fitted.push_back(static_cast<Eigen::Index>(k));
  return c;
}

DiagnosisRunner::DiagnosisRunner(const DiagnosisSettings& settings, const RunContext& context, SimulationLedger& ledger)
    : settings_(settings), context_(context), ledger_(ledger) {}

std::vector<std::uint64_t> DiagnosisRunner::seeds(std::uint64_t block, int num) const {
  std::vector<std::uint64_t> list;
  for (int k = 0; k < num; ++k) list.push_back(settings_.seed + block * block_size + static_cast<std::uint64_t>(k));
  return list;
}

Evaluator DiagnosisRunner::evaluator_of(const SoilCase& soil, TargetScope scope) const {
  return Evaluator(dem_simulator(soil.campaign.means, settings_.fidelity, context_, scope, FailedTest::leaves_others),
                   soil.targets, "diagnosis", ledger_, scope, MissingFeatures::keep);
}

Eigen::VectorXd DiagnosisRunner::best_start(const SoilCase& soil, Evaluator& evaluator) const {
  const Eigen::VectorXd nominal = unit_start(soil.parameters);
  Eigen::MatrixXd units =
      shifted_sobol_points(settings_.num_starts, static_cast<int>(nominal.size()), settings_.seed);
  units = ((2.0 * units.array() - 1.0) * start_range).matrix().colwise() + nominal;
  units = units.cwiseMax(0.02).cwiseMin(0.98);
  units.col(0) = nominal;
  Eigen::MatrixXd points(static_cast<Eigen::Index>(soil.parameters.size()), units.cols());
  for (Eigen::Index i = 0; i < units.cols(); ++i) points.col(i) = physical_point(soil.parameters, units.col(i));
  const std::vector<Evaluation> runs = evaluator.evaluate(points, seeds(baseline_block, 1).front());
  Eigen::Index best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < units.cols(); ++i) {
    const Eigen::VectorXd t = transformed_features(soil.targets, runs[static_cast<std::size_t>(i)]);
    double cost = 0.0;
    for (const Eigen::Index k : soil.fitted) {
      const Target& target = soil.targets[static_cast<std::size_t>(k)];
      const double z = (t[k] - transformed(target, target.value)) / std::hypot(target.sigma, usual_packing_cv * soil.campaign.scale[k]);
      cost += std::isfinite(z) ? z * z : cost_of_missing;
    }
    if (cost < least) {
      least = cost;
      best = i;
    }
  }
  return units.col(best);
}

void DiagnosisRunner::fit_baseline(SoilCase& soil, Evaluator& evaluator, Evaluator& around) const {
  EvidencePlan plan;
  plan.residual_seeds = seeds(baseline_block, settings_.num_refit_packings);
  plan.derivative_seeds = seeds(baseline_block, 3);
  const auto rows = all_rows(soil);
  for (int pass = 0; pass < settings_.num_baseline_passes; ++pass) {
    const auto near = simulate_evidence(evaluator, around, soil.fitted, soil.parameters, soil.targets, soil.unit, {}, plan);
    if (!near) return;
    const Eigen::MatrixXd covariance =
        noise_covariance(samples_of(soil.campaign, near->packings, rows), priors_of(soil.campaign, near->packings, rows)).total();
    const RefitProblem problem{soil.parameters, soil.targets, measured_means(soil), covariance,
                               finite_or_zero(near->jacobian), soil.fitted, plan.residual_seeds};
    const Refit better = refit(evaluator, problem, soil.unit, {}, {}, settings_.max_refit_steps);
    if (!better.is_usable) return;
    const double moved = (better.unit - soil.unit).cwiseAbs().maxCoeff();
    soil.unit = better.unit;
    if (moved < converged_move) return;
  }
}

void DiagnosisRunner::gather(SoilCase& soil, const std::optional<Eigen::VectorXd>& values) const {
  if (soil.fitted.empty()) {
    soil.failure = "all targets are held out";
    return;
  }
  if (values) {
    const std::vector<std::size_t> free = free_parameters(soil.parameters);
    soil.unit.resize(static_cast<Eigen::Index>(free.size()));
    for (std::size_t j = 0; j < free.size(); ++j)
      soil.unit[static_cast<Eigen::Index>(j)] =
          unit_from_physical(soil.parameters[free[j]], (*values)[static_cast<Eigen::Index>(free[j])]);
  }
  Evaluator evaluator = evaluator_of(soil, TargetScope::all), around = evaluator_of(soil, TargetScope::fitted);
  begin_stage(ledger_, "baseline");
  if (!values) soil.unit = best_start(soil, around);
  fit_baseline(soil, evaluator, around);
  begin_stage(ledger_, "fingerprints");
  const EvidencePlan plan{seeds(residual_block, settings_.num_residual_packings),
                          seeds(derivative_block, settings_.num_derivative_packings)};
  auto simulated =
      simulate_evidence(evaluator, around, soil.fitted, soil.parameters, soil.targets, soil.unit, steps_of(soil), plan);
  if (!simulated) {
    soil.failure = is_blocked(ledger_) ? "stopped before the evidence was complete"
                                       : "fewer than two packings completed at the fitted values";
    return;
  }
  soil.simulated = std::move(*simulated);
  hold_at_bounds(soil, soil.simulated, soil.remarks);
  const auto rows = all_rows(soil);
  soil.covariance =
      noise_covariance(samples_of(soil.campaign, soil.simulated.packings, rows), priors_of(soil.campaign, soil.simulated.packings, rows)).total();
  soil.evidence.soil = soil.campaign.means.id;
  soil.evidence.model = linear_model(soil.campaign.means, soil.simulated, soil.fitted);
  soil.evidence.samples = samples_of(soil.campaign, soil.simulated.packings, soil.fitted);
  soil.evidence.noise = priors_of(soil.campaign, soil.simulated.packings, soil.fitted);
  for (const CandidateChoice& c : soil.choices) soil.evidence.candidates.push_back(c.candidate);
  soil.gates = gates_of(soil);
}

void DiagnosisRunner::refit_models(SoilCase& soil, const std::vector<std::vector<std::size_t>>& contenders) const {
  begin_stage(ledger_, "refits");
  Evaluator evaluator = evaluator_of(soil, TargetScope::all);
  const RefitProblem problem{soil.parameters,
                             soil.targets,
                             measured_means(soil),
                             soil.covariance,
                             finite_or_zero(soil.simulated.jacobian),
                             soil.fitted,
                             seeds(refit_block, settings_.num_refit_packings)};
  std::vector<std::vector<std::size_t>> models = {{}};
  models.insert(models.end(), contenders.begin(), contenders.end());
  for (const std::vector<std::size_t>& effects : models) {
    RefittedModel model;
    std::vector<FreeEffect> free;
    Eigen::VectorXd sizes(static_cast<Eigen::Index>(effects.size()));
    for (const std::size_t k : effects) {
      const CandidateChoice& c = soil.choices[k];
      model.effects.push_back(c.candidate.id);
      sizes[static_cast<Eigen::Index>(free.size())] = c.step.null_value;
      free.push_back({c.step.settings.front().first, c.parameter->lower, c.parameter->upper,
                      finite_or_zero(soil.simulated.fingerprints).col(static_cast<Eigen::Index>(k)),
                      {c.step.settings.begin() + 1, c.step.settings.end()}});
    }
    model.refit = refit(evaluator, problem, soil.unit, free, sizes, settings_.max_refit_steps);
    if (model.refit.is_usable) model.gaps = gaps_of(soil, model.refit.residual);
    soil.models.push_back(std::move(model));
  }
}

std::vector<ExperimentAdvice> DiagnosisRunner::advise(const SoilCase& soil,
                                                      const std::vector<std::size_t>& contenders) const {
  if (contenders.size() < 2) return {};
  begin_stage(ledger_, "advice");
  std::vector<PossibleExperiment> possible;
  for (const std::string& test : laboratory_tests()) {
    const auto& targets = soil.campaign.means.targets;
    if (std::ranges::find(targets, test, &SoilTarget::test_id) != targets.end()) continue;
    SoilData other = soil.campaign.means;
    set_laboratory(other, std::vector<std::string>{test});
    for (SoilTarget& t : other.targets) t.value = 1.0;
    std::vector<EffectStep> steps = steps_of(soil);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const auto& tests = soil.choices[k].effect->tests;
      steps[k].is_active = std::ranges::find(contenders, k) != contenders.end() &&
                           std::ranges::find(tests, test) != tests.end();
    }
    const std::vector<Target> other_targets = fit_targets(other);
    Evaluator evaluator(dem_simulator(other, Fidelity::preview, context_, TargetScope::all, FailedTest::leaves_others),
                        other_targets, "advice", ledger_, TargetScope::all, MissingFeatures::keep);
    const EvidencePlan plan{seeds(advice_block, settings_.num_advice_packings),
                            seeds(advice_block, settings_.num_advice_packings)};
    std::vector<Eigen::Index> rows(other.targets.size());
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<Eigen::Index>(k);
    const auto simulated = simulate_evidence(evaluator, evaluator, rows, soil.parameters, other_targets, soil.unit, steps, plan);
    if (!simulated) continue;
    const Eigen::VectorXd variances =
        pooled_packing_variances(other, simulated->packings).array() / settings_.num_residual_packings +
        planned_cv * planned_cv / planned_replicates;
    possible.push_back({test, linear_model(other, *simulated, rows), variances.asDiagonal(), 1.0});
  }
  Eigen::VectorXd sizes(static_cast<Eigen::Index>(soil.choices.size()));
  for (std::size_t k = 0; k < soil.choices.size(); ++k)
    sizes[static_cast<Eigen::Index>(k)] = soil.choices[k].candidate.typical;
  const Eigen::MatrixXd v = noise_covariance(soil.evidence.samples, soil.evidence.noise).total();
  return next_experiments(soil.evidence.model, v, contenders, sizes, possible);
}

}  // namespace tilth
