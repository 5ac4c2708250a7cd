// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/dem_problem.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calibrate/config_error.hpp"
#include "calibrate/parallel.hpp"
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

/// Results of all tests, [test][member].
using TestResults = std::vector<std::vector<ExperimentResult>>;

/// The members of one packing: they share its lanes.
struct SeedGroup {
  std::uint64_t seed = 0;
  std::vector<std::size_t> columns;
  std::vector<SoilMaterial> materials;
};

std::vector<SeedGroup> groups_of(const SoilData& soil, const Eigen::MatrixXd& parameters,
                                 std::span<const std::uint64_t> seeds) {
  std::vector<SeedGroup> groups;
  for (std::size_t m = 0; m < seeds.size(); ++m) {
    auto group = std::ranges::find(groups, seeds[m], &SeedGroup::seed);
    if (group == groups.end()) {
      groups.push_back({seeds[m], {}, {}});
      group = groups.end() - 1;
    }
    group->columns.push_back(m);
    group->materials.push_back(material_of(soil, parameters.col(static_cast<Eigen::Index>(m))));
  }
  return groups;
}

Evaluation evaluation_of(const std::vector<PlannedTest>& tests, const TestResults& results,
                         std::size_t member, std::size_t num_targets) {
  Evaluation e;
  e.features = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(num_targets),
                                         std::numeric_limits<double>::quiet_NaN());
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const ExperimentResult& r = results[t][member];
    if (r.status != RunStatus::completed) {
      const bool stopped = r.status == RunStatus::stopped;
      return {stopped ? EvaluationStatus::skipped : EvaluationStatus::failed,
              {},
              fmt::format("{} ({}): {}", test_id(tests[t].config), name_of(r.status), r.message)};
    }
    for (const PlannedTest::Answer& a : tests[t].answers)
      e.features[static_cast<Eigen::Index>(a.target)] = r.feature(a.feature);
  }
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

RunOptions run_options(const RunContext& context) {
  RunOptions options;
  options.max_lanes = context.max_lanes;
  options.stop = context.stop;
  options.for_each = [n = context.num_threads](std::size_t count, const auto& body) {
    parallel_for_each_index(count, n, body);
  };
  return options;
}

Simulator dem_simulator(const SoilData& soil, Fidelity fidelity, const RunContext& context,
                        TargetScope scope) {
  return [&soil, &context, tests = plan_tests(soil, fidelity, scope)](
             const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    const std::vector<SeedGroup> groups = groups_of(soil, parameters, seeds);
    const RunOptions options = run_options(context);
    std::vector<TestResults> results(groups.size(), TestResults(tests.size()));
    // Every test on every packing is a task of its own: one member on several seeds fills the
    // threads as well as several members on one.
    parallel_for_each_index(groups.size() * tests.size(), context.num_threads, [&](std::size_t k) {
      const SeedGroup& group = groups[k / tests.size()];
      const std::size_t t = k % tests.size();
      TestConfig config = tests[t].config;
      set_packing_seed(config, group.seed);
      results[k / tests.size()][t] =
          run_virtual_test(config, group.materials, context.packings, options);
    });
    std::vector<Evaluation> evaluations(seeds.size());
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (std::size_t m = 0; m < groups[g].columns.size(); ++m)
        evaluations[groups[g].columns[m]] =
            evaluation_of(tests, results[g], m, soil.targets.size());
    return evaluations;
  };
}

}  // namespace tilth
