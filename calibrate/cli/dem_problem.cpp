// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/dem_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "calibrate/config_error.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

/// @throws ConfigError naming the condition and everything the test cannot be run with
void check_setup(const TestConfig& config, const TestCondition& condition) {
  std::vector<std::string> found = problems(config);
  for (std::string& p : found)
    p = fmt::format("condition '{}' (conditions.csv:{}) of {}: {}", condition.id, condition.line,
                    test_id(config), p);
  if (!found.empty()) throw ConfigError(std::move(found));
}

/// @param results  one per test
Evaluation evaluation_of(const std::vector<PlannedTest>& tests,
                         std::span<const ExperimentResult> results, std::size_t num_targets,
                         FailedTest failed_test) {
  Evaluation e;
  bool any_completed = false;
  e.features = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(num_targets),
                                         std::numeric_limits<double>::quiet_NaN());
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const ExperimentResult& r = results[t];
    if (r.status != RunStatus::completed) {
      const bool stopped = r.status == RunStatus::stopped;
      const std::string reason =
          fmt::format("{} ({}): {}", test_id(tests[t].config), name_of(r.status), r.message);
      if (stopped) return {EvaluationStatus::skipped, {}, reason};
      if (failed_test == FailedTest::fails_member) return {EvaluationStatus::failed, {}, reason};
      e.message += (e.message.empty() ? "" : "; ") + reason;
      continue;
    }
    any_completed = true;
    for (const PlannedTest::Answer& a : tests[t].answers)
      e.features[static_cast<Eigen::Index>(a.target)] = r.feature(a.feature);
  }
  if (!any_completed) return {EvaluationStatus::failed, {}, e.message};
  e.status = EvaluationStatus::completed;
  return e;
}

}  // namespace

std::vector<PlannedTest> plan_tests(const SoilData& soil, Fidelity fidelity, TargetScope scope) {
  std::vector<PlannedTest> tests;
  for (std::size_t k = 0; k < soil.targets.size(); ++k) {
    const SoilTarget& target = soil.targets[k];
    const bool wanted =
        scope == TargetScope::all || target.holdout == (scope == TargetScope::holdouts);
    if (!wanted) continue;
    const TestCondition* condition = soil.condition(target.condition_id);
    if (!condition) throw ConfigError({label(target) + ": its condition is not in conditions.csv"});
    TestConfig config = virtual_test(target.test_id, fidelity);
    apply_soil_state(config, soil);
    apply_condition(config, *condition);
    check_setup(config, *condition);
    auto test =
        std::ranges::find_if(tests, [&](auto& t) { return join_series(t.config, config); });
    if (test == tests.end()) {
      tests.push_back({config, target.condition_id, {}});
      test = tests.end() - 1;
    }
    test->answers.push_back({k, feature_name(target, *condition)});
  }
  return tests;
}

SoilMaterial material_of(const SoilData& soil, const Eigen::VectorXd& values) {
  const Eigen::VectorXd all = with_ties(soil.parameters, values);
  SoilMaterial material;
  const std::vector<Field> names = fields(material);
  for (std::size_t k = 0; k < soil.parameters.size(); ++k) {
    const Field* field = find_field(names, soil.parameters[k].id);
    if (!field)
      throw ConfigError({soil.parameters[k].id + " in parameters.csv is no parameter of the model"});
    *std::get<double*>(field->value) = all[static_cast<Eigen::Index>(k)];
  }
  return material;
}

Simulator dem_simulator(const SoilData& soil, Fidelity fidelity, const RunContext& context,
                        TargetScope scope, FailedTest failed_test) {
  return [&soil, &context, failed_test, tests = plan_tests(soil, fidelity, scope)](
             const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    std::vector<TestRun> runs;
    for (std::size_t m = 0; m < seeds.size(); ++m) {
      const SoilMaterial material = material_of(soil, parameters.col(static_cast<Eigen::Index>(m)));
      for (const PlannedTest& test : tests) {
        runs.push_back({test.config, test.condition_id, material});
        set_packing_seed(runs.back().config, seeds[m]);
      }
    }
    const std::vector<ExperimentResult> results = run_tests(runs, context);
    std::vector<Evaluation> evaluations;
    for (std::size_t m = 0; m < seeds.size(); ++m)
      evaluations.push_back(
          evaluation_of(tests, std::span(results).subspan(m * tests.size(), tests.size()),
                        soil.targets.size(), failed_test));
    return evaluations;
  };
}

}  // namespace tilth
