// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/twin_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

constexpr std::uint64_t first_packing = 600'000'000;
constexpr std::uint64_t packings_per_seed = 1000;
constexpr double least_stated_sigma = 0.01;

/// Independent streams of one seed.
enum class Stream : std::uint64_t { truth = 1, rigs, specimens };

std::mt19937_64 generator(std::uint64_t seed, Stream stream) {
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(stream)};
  return std::mt19937_64(words);
}

std::vector<Evaluation> specimens(const SoilData& soil, const Eigen::VectorXd& values, const TwinPlan& plan,
                                  const RunContext& context) {
  const Simulator laboratory =
      dem_simulator(soil, plan.fidelity, context, TargetScope::all, FailedTest::leaves_others);
  std::vector<std::uint64_t> seeds;
  for (int n = 0; n < plan.num_replicates; ++n) seeds.push_back(twin_packing(plan.seed, n));
  return laboratory(values.replicate(1, plan.num_replicates), seeds);
}

/// Standard deviation of the logarithms.
double log_deviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) sum += std::log(v) / n;
  for (const double v : values) squares += (std::log(v) - sum) * (std::log(v) - sum);
  return std::sqrt(squares / (n - 1.0));
}

double deviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) sum += v / n;
  for (const double v : values) squares += (v - sum) * (v - sum);
  return std::sqrt(squares / (n - 1.0));
}

/// Size of a number that may be negative: root mean square over the specimens that have it.
double size_of(const std::vector<Evaluation>& runs, Eigen::Index k) {
  double squares = 0.0, n = 0.0;
  for (const Evaluation& run : runs)
    if (run.status == EvaluationStatus::completed && std::isfinite(run.features[k])) {
      squares += run.features[k] * run.features[k];
      n += 1.0;
    }
  return n > 0.0 ? std::sqrt(squares / n) : 0.0;
}

/// Why tests failed, each reason once.
std::string reasons(const std::vector<Evaluation>& runs) {
  std::vector<std::string> once;
  for (const Evaluation& run : runs)
    if (!run.message.empty() && std::ranges::find(once, run.message) == once.end()) once.push_back(run.message);
  return once.empty() ? "" : fmt::format(" ({})", fmt::join(once, "; "));
}

}  // namespace

std::uint64_t twin_packing(std::uint64_t seed, int replicate) {
  return first_packing + seed * packings_per_seed + static_cast<std::uint64_t>(replicate);
}

Eigen::VectorXd twin_truth(const SoilData& soil, const TwinPlan& plan) {
  std::mt19937_64 rng = generator(plan.seed, Stream::truth);
  std::uniform_real_distribution<double> offset(-0.2, 0.2);
  const std::vector<Parameter> parameters = fit_parameters(soil);
  Eigen::VectorXd values = nominal_values(soil);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    double& value = values[static_cast<Eigen::Index>(k)];
    if (parameters[k].estimate) {
      const double unit = unit_from_physical(parameters[k], value) + offset(rng);
      value = physical_from_unit(parameters[k], std::clamp(unit, 0.05, 0.95));
    }
    for (const ChosenEffect& e : plan.effects)
      if (e.parameter == parameters[k].name) value = e.value;
  }
  for (const CandidateChoice& c : candidate_choices(soil))  // what an effect needs beside its size
    if (std::ranges::find(plan.effects, c.parameter->name, &ChosenEffect::parameter) != plan.effects.end())
      for (std::size_t i = 1; i < c.step.settings.size(); ++i) {
        const auto [column, value] = c.step.settings[i];
        const std::string& name = soil.parameters[static_cast<std::size_t>(column)].id;
        if (std::ranges::find(plan.effects, name, &ChosenEffect::parameter) == plan.effects.end())
          values[column] = value;
      }
  return with_ties(soil.parameters, values);
}

TwinData make_twin(SoilData soil, const TwinPlan& plan, const RunContext& context) {
  set_laboratory(soil, plan.tests);
  add_effect_parameters(soil);
  const Eigen::VectorXd values = twin_truth(soil, plan);
  const std::vector<Evaluation> runs = specimens(soil, values, plan, context);
  return twin_of(std::move(soil), plan, values, runs);
}

TwinData twin_of(SoilData soil, const TwinPlan& plan, const Eigen::VectorXd& values,
                 const std::vector<Evaluation>& runs) {
  TwinData twin;
  twin.values = values;
  std::mt19937_64 rig_rng = generator(plan.seed, Stream::rigs), rng = generator(plan.seed, Stream::specimens);
  std::normal_distribution<double> normal;
  std::map<std::string, double> rig_factors;
  for (const std::string& test : chosen_tests({"all"})) rig_factors[test] = std::exp(plan.noise.rig_cv * normal(rig_rng));

  const std::vector<SoilTarget> planned = std::move(soil.targets);
  soil.targets.clear();
  for (std::size_t k = 0; k < planned.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const bool is_signed = planned[k].sigma_kind == SigmaKind::absolute;
    const double size = is_signed ? size_of(runs, column) : 0.0;
    std::vector<SoilTarget> rows;
    std::vector<double> numbers;
    for (std::size_t n = 0; n < runs.size(); ++n) {
      const double noise = plan.noise.specimen_cv * normal(rng), rig = rig_factors[planned[k].test_id];
      if (runs[n].status != EvaluationStatus::completed) continue;
      const double number = runs[n].features[column];
      if (!std::isfinite(number) || (!is_signed && number <= 0.0)) continue;
      SoilTarget row = planned[k];
      row.value = is_signed ? rig * number + noise * size : rig * std::exp(noise) * number;
      row.replicate_id = std::to_string(n + 1);
      row.origin = {Provenance::synthetic, "calibrate twin", "made by a model"};
      rows.push_back(row);
      numbers.push_back(row.value);
    }
    if (rows.size() < 2)
      throw ConfigError({fmt::format("{}: fewer than two specimens gave a {}number{}; take another seed or a smaller effect",
                                     label(planned[k]), is_signed ? "" : "positive ", reasons(runs))});
    for (SoilTarget& row : rows) {
      row.sigma = is_signed ? std::max(least_stated_sigma * size, deviation(numbers)) : std::max(least_stated_sigma, log_deviation(numbers));
      soil.targets.push_back(row);
    }
  }
  for (std::size_t n = 0; n < runs.size(); ++n)
    if (!runs[n].message.empty()) twin.lost.push_back(fmt::format("specimen {}: {}", n + 1, runs[n].message));
  twin.soil = std::move(soil);
  return twin;
}

}  // namespace tilth
