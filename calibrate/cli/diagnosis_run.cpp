// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/diagnosis_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/sobol_design.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

/// Blocks of packings; a fit of seed s uses s ... s + 2999.
enum SeedBlock : std::uint64_t { baseline_block = 1, residual_block, derivative_block, refit_block, advice_block };
constexpr std::uint64_t block_size = 10'000;

constexpr int baseline_derivative_packings = 3;
constexpr double start_range = 0.2;              ///< of the unit cube, about the nominal values: starts of the baseline
constexpr double usual_packing_cv = 0.06;        ///< while choosing a start
constexpr double cost_of_missing = 25.0;         ///< a number that a start cannot give
constexpr double converged_move = 0.005;         ///< of the unit cube
constexpr double planned_cv = 0.10;              ///< of specimens in advice, five of them
constexpr double planned_replicates = 5.0;

}  // namespace

DiagnosisSettings diagnosis_settings(bool quick, std::uint64_t seed) {
  DiagnosisSettings s;
  s.seed = seed;
  s.fidelity = quick ? Fidelity::preview : Fidelity::search;
  s.statistics.seed = seed;
  return s;
}

DiagnosisRunner::DiagnosisRunner(const DiagnosisSettings& settings, const RunContext& context, SimulationLedger& ledger)
    : settings_(settings), context_(context), ledger_(ledger) {}

std::size_t DiagnosisRunner::expected_simulations(const SoilCase& soil) const {
  constexpr int usual_passes = 2, usual_models = 4, usual_points = 3;  // beside the maxima in settings_
  const auto around = 1 + 2 * static_cast<int>(free_parameters(soil.parameters).size());
  int num_cheap = 0, num_costly = 0;
  for (const CandidateChoice& c : soil.choices)
    if (c.step.is_active) ++(c.step.is_costly ? num_costly : num_cheap);
  const int refit = usual_points * settings_.num_refit_packings;
  const int baseline = settings_.num_starts + usual_passes * (settings_.num_refit_packings + baseline_derivative_packings * around + refit);
  const int evidence = settings_.num_residual_packings + settings_.num_derivative_packings * (around + num_cheap) +
                       static_cast<int>(EvidencePlan{}.costly_packings) * num_costly;
  return static_cast<std::size_t>(baseline + evidence + usual_models * refit);
}

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
  plan.derivative_seeds = seeds(baseline_block, baseline_derivative_packings);
  for (int pass = 0; pass < settings_.num_baseline_passes; ++pass) {
    const auto near = simulate_evidence(evaluator, around, soil.fitted, soil.parameters, soil.targets, soil.unit, {}, plan);
    if (!near) return;
    const Eigen::MatrixXd covariance = noise_covariance_of(soil, near->packings);
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
  set_evidence(soil, std::move(*simulated));
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
