// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// How often is `calibrate diagnose` right? Effects are hidden in data of the real engine and looked for. From the repository's root:
//
//     build/release/bin/diagnose_scoreboard library                  # once per soil
//     build/release/bin/diagnose_scoreboard make development         # the hider: data folders
//     build/release/bin/diagnose_scoreboard seek development         # the seeker and the tables
//     build/release/bin/diagnose_scoreboard prove development        # the same with gaps by real simulations
//
// Everything lies under runs/scoreboard/ and goes on where it was stopped.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>

#include "bench/diagnose/cases.hpp"
#include "bench/diagnose/library.hpp"
#include "bench/diagnose/seek.hpp"
#include "bench/diagnose/tables.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/parallel.hpp"

namespace {

using namespace tilth;
using namespace tilth::scoreboard;
namespace fs = std::filesystem;

constexpr const char* soil_id = "loamy_sand";
constexpr double power_90 = 12.8 + 3.3;  ///< noncentrality of a test at 5 % over 16 candidates, 90 % power

/// What the look-alike map says of the hidden effect.
void add_map(Score& score, const Finding& f) {
  const SoilDiagnosis& d = f.diagnosis.soils.front();
  if (score.hidden.effects.empty() || score.hidden.effects.size() > 1) return;
  const ChosenEffect& hidden = score.hidden.effects.front();
  for (std::size_t k = 0; k < f.soil.choices.size(); ++k) {
    const CandidateChoice& c = f.soil.choices[k];
    if (c.candidate.id != hidden.id || d.scores[k].decision == EffectDecision::not_measurable) continue;
    const auto i = static_cast<Eigen::Index>(k);
    score.lambda = std::pow((hidden.value - c.step.null_value) / d.scores[k].standard_error, 2);
    for (Eigen::Index j = 0; j < d.look_alikes.cols(); ++j) {
      if (j == i || d.scores[static_cast<std::size_t>(j)].decision == EffectDecision::not_measurable) continue;
      if (std::abs(d.look_alikes(i, j)) > score.rho) {
        score.rho = std::abs(d.look_alikes(i, j));
        score.nearest = f.soil.choices[static_cast<std::size_t>(j)].candidate.id;
      }
    }
    score.can_see = score.lambda >= power_90;
    score.is_separable = score.lambda * (1.0 - score.rho) >= diagnosis_thresholds::separable_lambda;
  }
}

Score scored(const HiddenCase& hidden, const Finding& f) {
  const double nan = std::nan("");
  Score s;
  s.hidden = hidden;
  s.size_ratio = s.before = s.said = s.oracle = s.before_held_out = s.said_held_out = s.oracle_held_out = nan;
  s.verdict = to_string(f.diagnosis.verdict);
  for (const NamedEffect& e : f.diagnosis.effects) {
    s.names.push_back(e.id);
    for (const ChosenEffect& h : hidden.effects) {
      if (h.id != e.id || e.sizes.empty()) continue;
      const double null_value = f.soil.choices[e.effect].step.null_value;
      s.size_ratio = e.sizes.front().value / (h.value - null_value);
      s.size_inside = e.sizes.front().lo90 <= h.value - null_value && h.value - null_value <= e.sizes.front().hi90;
    }
  }
  s.set = f.diagnosis.set;
  s.set_holds_none = f.diagnosis.set_holds_none;
  s.set_holds_other = f.diagnosis.set_holds_other;
  if (f.diagnosis.posterior.inclusion.size() > 0) s.posterior = f.diagnosis.posterior.inclusion.maxCoeff();
  if (!f.diagnosis.soils.empty()) add_map(s, f);
  return s;
}

/// The models of a case that are proven by real simulations: baseline, what was said, what was hidden.
struct Proofs {
  std::size_t score = 0;
  int before = -1, said = -1, oracle = -1;  ///< positions among the jobs
};

void add_proofs(const EmulatedLaboratory& laboratory, const HiddenCase& hidden, const Finding& f, std::size_t score,
                std::vector<ProofJob>& jobs, std::vector<Proofs>& proofs) {
  if (hidden.kind != CaseKind::single || f.diagnosis.soils.empty()) return;
  const auto add = [&](const std::vector<std::size_t>& effects) {
    jobs.push_back({&f, emulated_fit(laboratory, f.soil, f.soil.covariance, effects)});
    return static_cast<int>(jobs.size()) - 1;
  };
  Proofs p;
  p.score = score;
  p.before = add({});
  std::vector<std::size_t> truth, named;
  for (std::size_t k = 0; k < f.soil.choices.size(); ++k)
    if (f.soil.choices[k].candidate.id == hidden.effects.front().id) truth.push_back(k);
  for (const NamedEffect& e : f.diagnosis.effects) named.push_back(e.effect);
  p.oracle = add(truth);
  if (named == truth) p.said = p.oracle;
  else if (!named.empty()) p.said = add(named);
  proofs.push_back(p);
}

/// What such data could see at all: noncentrality of every candidate at its typical size, over the cases' own fits and noise.
std::string visibility_table(const Library& library, const std::vector<std::unique_ptr<Finding>>& findings) {
  std::string text = "| candidate | measurable in | median lambda at typical size | seen with a power of 90 % in |\n| --- | ---: | ---: | ---: |\n";
  for (std::size_t k = 0; k < library.choices.size(); ++k) {
    if (!library.choices[k].step.is_active) continue;
    std::vector<double> lambdas;
    int num_measurable = 0, num_seen = 0;
    for (const auto& f : findings) {
      if (!f || f->diagnosis.soils.empty()) continue;
      const EffectScore& s = f->diagnosis.soils.front().scores[k];
      const bool is_measurable = s.decision != EffectDecision::not_measurable;
      lambdas.push_back(is_measurable ? std::pow(library.choices[k].candidate.typical / s.standard_error, 2) : 0.0);
      num_measurable += is_measurable;
      num_seen += lambdas.back() >= power_90;
    }
    if (lambdas.empty()) continue;
    std::ranges::sort(lambdas);
    text += fmt::format("| {} | {} of {} | {:.1f} | {} of {} |\n", library.choices[k].candidate.id, num_measurable, lambdas.size(),
                        lambdas[lambdas.size() / 2], num_seen, lambdas.size());
  }
  return text;
}

void seek_batch(const BatchPlan& batch, const Library& library, const fs::path& folder, const RunContext& context, Fidelity fidelity,
                bool with_proofs) {
  const EmulatedLaboratory laboratory(library);
  fmt::print("| statistic | Q2 | leave-one-out rms |\n| --- | ---: | ---: |\n");
  for (const EmulatorQuality& q : laboratory.quality()) fmt::print("| {} | {:.3f} | {:.3f} |\n", q.statistic, q.q2, q.root_mean_square);
  const std::vector<HiddenCase> cases = draw_cases(batch, library);
  std::vector<std::unique_ptr<Finding>> findings(cases.size());
  std::vector<Score> scores(cases.size());
  parallel_for_each_index(cases.size(), context.num_threads, [&](std::size_t k) {
    const fs::path data = folder / "data" / cases[k].id;
    scores[k].hidden = cases[k];
    if (!fs::exists(data / "soil.json")) {
      scores[k].is_lost = true;
      return;
    }
    DiagnosisOptions options;
    options.num_repetitions = 0;  // the tail of X2 and adjusted tails do not enter the verdict
    findings[k] = std::make_unique<Finding>(seek(laboratory, data, cases[k].struck_candidate, options));
    scores[k] = scored(cases[k], *findings[k]);
  });
  std::vector<ProofJob> jobs;
  std::vector<Proofs> proofs;
  for (std::size_t k = 0; k < cases.size(); ++k)
    if (findings[k] && with_proofs) add_proofs(laboratory, cases[k], *findings[k], k, jobs, proofs);
  if (with_proofs) fmt::print(stderr, "proofs: {} models\n", jobs.size());
  const std::vector<ProvenGap> gaps = prove(laboratory, jobs, fidelity, context);
  for (const Proofs& p : proofs) {
    Score& s = scores[p.score];
    const auto put = [&](int job, double& fitted, double& held_out) {
      if (job < 0) return;
      fitted = gaps[static_cast<std::size_t>(job)].fitted;
      held_out = gaps[static_cast<std::size_t>(job)].held_out;
    };
    put(p.before, s.before, s.before_held_out);
    put(p.said, s.said, s.said_held_out);
    put(p.oracle, s.oracle, s.oracle_held_out);
  }
  std::string csv = csv_heading();
  for (const Score& s : scores) csv += csv_line(s);
  write_file(folder / "scores.csv", csv);
  const std::string text = tables(scores) + "\n" + visibility_table(library, findings);
  write_file(folder / "tables.md", text);
  fmt::print("\n{}", text);
}

int run(const std::string& step, const std::string& name) {
  const fs::path root = "runs/scoreboard", soil_folder = fs::path(TILTH_SOURCE_DIR) / "data/soils" / soil_id;
  PackingStore packings(root / "packings");
  const RunContext context{packings, threads_or_all(0)};
  const LibraryPlan plan;
  const auto library = [&] { return stored_library(soil_folder, plan, root / (std::string("library_") + soil_id + ".csv"), context); };
  if (step == "library") {
    (void)library();
    return 0;
  }
  const BatchPlan batch = batch_plan(name);
  const fs::path folder = root / batch.name;
  if (step == "make") {
    SoilData soil = load_soil(soil_folder);
    const Library drawn_from = library();
    fs::create_directories(folder / "data");
    make_cases(draw_cases(batch, drawn_from), soil_folder, plan.fidelity, folder / "data", context);
  } else {
    seek_batch(batch, library(), folder, context, plan.fidelity, step == "prove");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string step = argc > 1 ? argv[1] : "";
  const bool is_known = (step == "library" && argc == 2) || ((step == "make" || step == "seek" || step == "prove") && argc == 3);
  if (!is_known) {
    fmt::print(stderr, "diagnose_scoreboard library | make BATCH | seek BATCH | prove BATCH      (development, sealed-1)\n");
    return 2;
  }
  try {
    return run(step, argc == 3 ? argv[2] : "");
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
}
