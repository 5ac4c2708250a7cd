// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Hidden effects in the linear toy: three ways of naming them beside each other. Prints Markdown.
//
//     build/release/bin/diagnosis_toy           # 25 cases per effect and row, the tables of the
//     docs build/release/bin/diagnosis_toy 5         # fewer
#include "tests/support/diagnosis_toy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calibrate/diagnosis/separability.hpp"

namespace {

using namespace tilth;
using namespace tilth::test;

constexpr int num_resamples = 60;
constexpr double two_sided_bonferroni = 2.96;  // 5 % over 16 candidates

using Maker = std::function<ToyCase(int, std::mt19937_64&)>;

struct Counts {
  int num = 0, right = 0, wrong = 0;
};

// The naive rule: the largest score beyond Bonferroni's limit is the name.
void add_largest_score(Counts& counts, const Toy& toy, const ToyCase& made, double freedom) {
  SoilEvidence evidence = made.evidence;
  evidence.noise.freedom = freedom;
  if (freedom == 0.0) evidence.noise.correlation = 0.0;
  const Eigen::VectorXd z = signed_scores(analysed(evidence).projected);
  Eigen::Index best = 0;
  ++counts.num;
  if (z.cwiseAbs().maxCoeff(&best) < two_sided_bonferroni) return;
  const std::string& id = toy.candidates()[static_cast<std::size_t>(best)].id;
  const auto hidden = std::ranges::find(toy.ids(), id) - toy.ids().begin();
  ++(made.truth[hidden] != 0.0 ? counts.right : counts.wrong);
}

double percent(int count, int num) { return 100.0 * count / num; }

// One row: plug-in V, moderated V, posterior, posterior with resampling.
void print_row(const Toy& toy, const std::string& name, int num, const Maker& make) {
  std::mt19937_64 rng(20261122);
  Counts plug_in, moderated;
  ToyTally posterior, stable;
  for (int i = 0; i < num; ++i) {
    const ToyCase made = make(i, rng);
    add_largest_score(plug_in, toy, made, 0.0);
    add_largest_score(moderated, toy, made, diagnosis_thresholds::moderation_freedom);
    const std::span<const SoilEvidence> soil(&made.evidence, 1);
    const Diagnosis quick = diagnose(soil, {.num_resamples = 0, .num_repetitions = 0});
    posterior.add(answer_of(toy, made.truth, quick), quick);
    const Diagnosis full = diagnose(soil, {.num_resamples = num_resamples, .num_repetitions = 0});
    stable.add(answer_of(toy, made.truth, full), full);
  }
  const auto cell = [](const ToyTally& t) {
    return fmt::format("{:.0f}/{:.1f}/{:.0f}/{:.0f}", 100.0 * t.share(ToyAnswer::right),
                       100.0 * t.share(ToyAnswer::wrong), 100.0 * t.share(ToyAnswer::set),
                       100.0 * t.share(ToyAnswer::other));
  };
  fmt::print("| {} | {} | {:.0f}/{:.0f} | {:.0f}/{:.0f} | {} | {} | {:.0f} |\n", name, num,
             percent(plug_in.right, num), percent(plug_in.wrong, num),
             percent(moderated.right, num), percent(moderated.wrong, num), cell(posterior),
             cell(stable), percent(stable.num_suggested, num));
  std::fflush(stdout);
}

ToyCase pair_of(const Toy& toy, int i, std::mt19937_64& rng) {
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(toy.num_effects());
  const Eigen::Index first = i % toy.num_effects();
  sizes[first] = 1.0;
  sizes[(first + 1 + static_cast<Eigen::Index>(rng() % 15)) % toy.num_effects()] = 1.0;
  return toy.hidden(sizes, rng);
}

void print_data(ToyData data, const std::string& name, int per_effect) {
  const Toy toy(data);
  const int num = per_effect * static_cast<int>(toy.num_effects());
  const auto single = [&](double size) -> Maker {
    return [&toy, size](int i, std::mt19937_64& rng) {
      return toy.hidden(i % toy.num_effects(), size, rng);
    };
  };
  const auto distorted = [&](double share) -> Maker {
    return [&toy, share](int i, std::mt19937_64& rng) {
      return toy.distorted(i % toy.num_effects(), share, rng);
    };
  };
  print_row(toy, name + ", null", num, single(0.0));
  print_row(toy, name + ", 0.5x", num, single(0.5));
  print_row(toy, name + ", 1x", num, single(1.0));
  print_row(toy, name + ", 2x", num, single(2.0));
  print_row(toy, name + ", outside", num,
            [&](int, std::mt19937_64& rng) { return toy.outside(rng); });
  if (data == ToyData::field) return;
  print_row(toy, name + ", pairs", num,
            [&](int i, std::mt19937_64& rng) { return pair_of(toy, i, rng); });
  print_row(toy, name + ", law 20 % off", num, distorted(0.2));
  print_row(toy, name + ", law 40 % off", num, distorted(0.4));
  print_row(toy, name + ", law 60 % off", num, distorted(0.6));
  print_row(toy, name + ", shuffled", num,
            [&](int i, std::mt19937_64& rng) { return toy.shuffled(i % toy.num_effects(), rng); });
}

// Every effect once missing from the catalogue.
void print_left_out(ToyData data, const std::string& name, int per_effect) {
  std::mt19937_64 rng(7);
  const Toy all(data);
  int num = 0, posterior = 0, checked = 0, stable = 0, other = 0, nothing = 0;
  for (Eigen::Index k = 0; k < all.num_effects(); ++k) {
    const Toy toy(data, all.ids()[static_cast<std::size_t>(k)]);
    for (int i = 0; i < per_effect; ++i) {
      const ToyCase made = toy.hidden(k, 1.0, rng);
      const std::span<const SoilEvidence> soil(&made.evidence, 1);
      const Diagnosis quick = diagnose(soil, {.num_resamples = 0, .num_repetitions = 0});
      const Diagnosis full = diagnose(soil, {.num_resamples = num_resamples, .num_repetitions = 0});
      ++num;
      posterior += quick.posterior.inclusion.maxCoeff() > diagnosis_thresholds::name_probability;
      checked += !quick.effects.empty();
      stable += !full.effects.empty();
      other += full.verdict == Verdict::outside_catalogue;
      nothing += full.verdict == Verdict::none;
    }
  }
  fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.0f} |\n", name, num,
             percent(posterior, num), percent(checked, num), percent(stable, num),
             percent(other, num), percent(nothing, num));
}

void print_effects(int per_effect) {
  const Toy core(ToyData::core);
  const Toy extras(ToyData::extras);
  fmt::print(
      "\n| effect | kept, core | lambda at 1x | nearest | right, core | right, extras |\n"
      "| --- | --- | --- | --- | --- | --- |\n");
  const Eigen::MatrixXd v = core.usual_covariance();
  const ProjectedEvidence e = project(core.exact_model(), Eigen::VectorXd::Zero(v.rows()), v);
  const Eigen::MatrixXd rho = look_alike_map(e) - Eigen::MatrixXd::Identity(16, 16);
  for (Eigen::Index k = 0; k < core.num_effects(); ++k) {
    Eigen::Index nearest = 0;
    const double cosine = rho.col(k).cwiseAbs().maxCoeff(&nearest);
    const auto right = [&](const Toy& toy) {
      std::mt19937_64 rng(99);
      ToyTally counts;
      for (int i = 0; i < per_effect; ++i) {
        const ToyCase made = toy.hidden(k, 1.0, rng);
        const Diagnosis d = diagnose(std::span(&made.evidence, 1),
                                     {.num_resamples = num_resamples, .num_repetitions = 0});
        counts.add(answer_of(toy, made.truth, d), d);
      }
      return 100.0 * counts.share(ToyAnswer::right);
    };
    fmt::print("| {} | {:.2f} | {:.0f} | {} {:.2f} | {:.0f} | {:.0f} |\n",
               core.short_names()[static_cast<std::size_t>(k)], e.kept[k],
               e.fingerprints.col(k).squaredNorm(),
               core.short_names()[static_cast<std::size_t>(nearest)], cosine, right(core),
               right(extras));
  }
}

void print_reliability(ToyData data, const std::string& name, int num) {
  const Toy toy(data);
  std::mt19937_64 rng(5);
  Reliability bins;
  for (int i = 0; i < num; ++i) {
    const ToyCase made = case_of_prior(toy, rng);
    bins.add(toy, made,
             diagnose(std::span(&made.evidence, 1), {.num_resamples = 0, .num_repetitions = 0})
                 .posterior);
  }
  for (std::size_t b = 0; b < bins.num.size(); ++b)
    fmt::print("| {} | {:.2f} to {:.2f} | {} | {:.3f} | {:.3f} |\n", name, Reliability::edges[b],
               Reliability::edges[b + 1], bins.num[b], bins.sum[b] / bins.num[b],
               static_cast<double>(bins.num_true[b]) / bins.num[b]);
}

void print_sizes(ToyData data, const std::string& name, int per_effect) {
  const Toy toy(data);
  std::mt19937_64 rng(6);
  std::vector<double> errors;
  int covered = 0, holds = 0, num = 0;
  std::size_t set_size = 0;
  for (int i = 0; i < per_effect * 16; ++i, ++num) {
    const Eigen::Index k = i % toy.num_effects();
    const ToyCase made = toy.hidden(k, 1.0, rng);
    const Diagnosis d =
        diagnose(std::span(&made.evidence, 1), {.num_resamples = 0, .num_repetitions = 0});
    const std::string& id = toy.ids()[static_cast<std::size_t>(k)];
    holds += std::ranges::find(d.set, id) != d.set.end();
    set_size += d.set.size() + (d.set_holds_none ? 1 : 0) + (d.set_holds_other ? 1 : 0);
    for (const NamedEffect& effect : d.effects) {
      if (effect.id != id) continue;
      errors.push_back(std::abs(effect.sizes[0].value - 1.0));
      covered += effect.sizes[0].lo90 <= 1.0 && 1.0 <= effect.sizes[0].hi90;
    }
  }
  std::ranges::sort(errors);
  const int num_named = static_cast<int>(errors.size());
  fmt::print("| {} | {} | {:.1f} | {:.2f} | {} | {:.0f} % | {:.1f} |\n", name, num,
             percent(holds, num), static_cast<double>(set_size) / num, num_named,
             100.0 * errors[errors.size() / 2], percent(covered, num_named));
}

}  // namespace

int main(int argc, char** argv) {
  const int per_effect = argc > 1 ? std::atoi(argv[1]) : 25;
  fmt::print(
      "| case | data sets | A right/wrong | B right/wrong | C right/wrong/set/other | D the "
      "same | of D suggested |\n| --- | --- | --- | --- | --- | --- | --- |\n");
  print_data(ToyData::core, "core", per_effect);
  print_data(ToyData::extras, "extras", per_effect);
  print_data(ToyData::field, "draught + tracer", per_effect);
  fmt::print(
      "\n| left out, 1x | data sets | name by posterior | after residual check | after "
      "resampling | outside | none |\n| --- | --- | --- | --- | --- | --- | --- |\n");
  print_left_out(ToyData::core, "core", per_effect);
  print_left_out(ToyData::extras, "extras", per_effect);
  print_effects(2 * per_effect);
  fmt::print(
      "\n| data | probability said | effects | mean said | were there |\n"
      "| --- | --- | --- | --- | --- |\n");
  print_reliability(ToyData::core, "core", 240 * per_effect);
  print_reliability(ToyData::extras, "extras", 240 * per_effect);
  fmt::print(
      "\n| data, 1x | data sets | 95 % set holds truth | mean size of set | right names | "
      "median size error | 90 % interval holds |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  print_sizes(ToyData::core, "core", 2 * per_effect);
  print_sizes(ToyData::extras, "extras", 2 * per_effect);
  return 0;
}
