// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/diagnose/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/laboratory_plan.hpp"
#include "calibrate/cli/measured_features.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/twin_files.hpp"
#include "calibrate/config_error.hpp"

namespace tilth::scoreboard {
namespace {

namespace fs = std::filesystem;

constexpr int cases_per_chunk = 8;  ///< that share five packings: one pack of lanes

/// Ratios no candidate changes: what the seeker's model takes for granted.
const std::vector<std::pair<std::string, std::vector<double>>> fixed_ratios = {
    {"stiffness_ratio", {6.0, 1.0}},
    {"bond_stiffness_ratio", {8.0, 0.8}},
    {"moment_contribution", {0.1, 0.4}},
    {"bond_radius_multiplier", {0.6, 0.75}},
};

using Rng = std::mt19937_64;

double even(Rng& rng, double low, double high) { return std::uniform_real_distribution<double>(low, high)(rng); }

template <typename T>
const T& one_of(Rng& rng, const std::vector<T>& list) {
  return list[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(rng)];
}

/// A size of `low` to `high` times the typical one, log-uniform, within the bounds.
ChosenEffect sized(Rng& rng, const CandidateChoice& c, double low, double high) {
  const EffectParameter& p = *c.parameter;
  const double factor = std::exp(even(rng, std::log(low), std::log(high)));
  double step = factor * (p.typical - p.null_value);
  if (p.side == EffectSide::free && c.kind != EffectKind::numerical && even(rng, 0.0, 1.0) < 0.5) step = -step;
  return {c.candidate.id, p.name, std::clamp(p.null_value + step, p.lower, p.upper)};
}

/// Twice a halving of the grains would be sixteen times the work.
ChosenEffect artefact(Rng& rng, const CandidateChoice& c) {
  return sized(rng, c, 0.5, c.kind == EffectKind::numerical ? 1.0 : 2.0);
}

bool moves_anything(const Library& library, int candidate) {
  for (const LibraryRow& r : library.rows) {
    if (r.candidate != candidate) continue;
    for (const LibraryRow& base : library.rows)
      if (base.kind == RowKind::design && base.point == r.point && base.packing == r.packing &&
          (base.features - r.features).cwiseAbs().maxCoeff() > 0.0)
        return true;
  }
  return false;
}

}  // namespace

const char* name_of(CaseKind kind) {
  switch (kind) {
    case CaseKind::single: return "single";
    case CaseKind::nothing: return "nothing";
    case CaseKind::trap: return "trap";
    case CaseKind::outside: return "outside";
    case CaseKind::pair: return "pair";
  }
  return "";
}

BatchPlan batch_plan(const std::string& name) {
  if (name == "development") return {name, 1'000, 14, 14, 6, 6, 4};
  if (name == "sealed-1") return {name, 2'000, 60, 60, 20, 20, 10};
  throw ConfigError({name + ": the batches are development and sealed-1"});
}

std::vector<HiddenCase> draw_cases(const BatchPlan& plan, const Library& library) {
  std::vector<const CandidateChoice*> soil, artefacts;
  for (std::size_t k = 0; k < library.choices.size(); ++k) {
    const CandidateChoice& c = library.choices[k];
    if (!moves_anything(library, static_cast<int>(k))) continue;
    const bool is_artefact = c.kind == EffectKind::measurement || c.kind == EffectKind::numerical;
    (is_artefact ? artefacts : soil).push_back(&c);
  }
  Rng rng(plan.seed);
  std::vector<HiddenCase> cases;
  const auto add = [&](CaseKind kind) -> HiddenCase& { return cases.emplace_back(HiddenCase{"", kind, 0, {}, {}, ""}); };
  for (int k = 0; k < plan.num_singles; ++k) add(CaseKind::single).effects = {sized(rng, *one_of(rng, soil), 0.5, 2.0)};
  for (int k = 0; k < plan.num_nothing; ++k) add(CaseKind::nothing);
  for (int k = 0; k < plan.num_traps; ++k) add(CaseKind::trap).effects = {artefact(rng, *one_of(rng, artefacts))};
  for (int k = 0; k < plan.num_outside; ++k) {
    HiddenCase& c = add(CaseKind::outside);
    if (k % 2 == 0) {
      c.effects = {sized(rng, *one_of(rng, soil), 1.0, 2.0)};
      c.struck_candidate = c.effects.front().id;
    } else {
      const auto& [name, values] = one_of(rng, fixed_ratios);
      c.model_changes = {{name, one_of(rng, values)}};
    }
  }
  for (int k = 0; k < plan.num_pairs; ++k) {
    HiddenCase& c = add(CaseKind::pair);
    const CandidateChoice* first = one_of(rng, soil);
    const CandidateChoice* second = first;
    while (second->effect == first->effect) second = one_of(rng, soil);
    c.effects = {sized(rng, *first, 1.0, 2.0), sized(rng, *second, 1.0, 2.0)};
  }
  std::ranges::shuffle(cases, rng);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    cases[k].id = fmt::format("{:04}", k + 1);
    cases[k].seed = plan.seed * 1'000 + k;
  }
  return cases;
}

void make_cases(const std::vector<HiddenCase>& cases, const fs::path& soil_folder, Fidelity fidelity,
                const fs::path& folder, const RunContext& context) {
  SoilData soil = load_soil(soil_folder);
  const std::vector<std::string> tests = chosen_tests({"laboratory"});
  set_laboratory(soil, tests);
  add_effect_parameters(soil);
  const Simulator laboratory = dem_simulator(soil, fidelity, context, TargetScope::all, FailedTest::leaves_others);
  for (std::size_t begin = 0; begin < cases.size(); begin += cases_per_chunk) {
    const std::size_t end = std::min(cases.size(), begin + cases_per_chunk);
    std::vector<TwinPlan> plans;
    std::vector<Eigen::VectorXd> truths;
    bool is_made = true;
    for (std::size_t k = begin; k < end; ++k) {
      const HiddenCase& c = cases[k];
      TwinPlan plan{tests, c.effects, {}, 5, fidelity, c.seed};
      Eigen::VectorXd values = twin_truth(soil, plan);
      for (const auto& [name, value] : c.model_changes) {
        const auto at = std::ranges::find(soil.parameters, name, &SoilParameter::id);
        if (at == soil.parameters.end()) throw ConfigError({name + ": no parameter of this soil"});
        values[at - soil.parameters.begin()] = value;
      }
      plans.push_back(plan);
      truths.push_back(values);
      is_made = is_made && (fs::exists(folder / c.id / "soil.json") || fs::exists(folder / (c.id + ".lost")));
    }
    if (is_made) continue;
    // replicate by replicate, the cases of a chunk on one packing
    const int num_replicates = plans.front().num_replicates;
    const auto num = static_cast<Eigen::Index>(plans.size());
    Eigen::MatrixXd values(truths.front().size(), num * num_replicates);
    std::vector<std::uint64_t> packings;
    for (int n = 0; n < num_replicates; ++n)
      for (Eigen::Index k = 0; k < num; ++k) {
        values.col(n * num + k) = truths[static_cast<std::size_t>(k)];
        packings.push_back(twin_packing(plans.front().seed, n));
      }
    const std::vector<Evaluation> runs = laboratory(values, packings);
    for (Eigen::Index k = 0; k < num; ++k) {
      const HiddenCase& c = cases[begin + static_cast<std::size_t>(k)];
      std::vector<Evaluation> own;
      for (int n = 0; n < num_replicates; ++n) own.push_back(runs[static_cast<std::size_t>(n * num + k)]);
      try {
        const TwinData twin = twin_of(soil, plans[static_cast<std::size_t>(k)], truths[static_cast<std::size_t>(k)], own);
        const fs::path out = folder / c.id;
        fs::create_directories(out);
        write_file(out / "conditions.csv", conditions_csv(twin.soil.conditions));
        write_file(out / "measurements.csv", measurements_csv(twin.soil.targets));
        fs::copy_file(soil_folder / "parameters.csv", out / "parameters.csv", fs::copy_options::overwrite_existing);
        write_file(out / "soil.json", twin_soil_json(twin.soil, c.id));
      } catch (const ConfigError& e) {
        write_file(folder / (c.id + ".lost"), std::string(e.what()) + "\n");
      }
    }
    fmt::print(stderr, "cases: {} of {}\n", end, cases.size());
  }
}

}  // namespace tilth::scoreboard
