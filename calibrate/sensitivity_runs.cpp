// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <limits>

#include "calibrate/morris.hpp"
#include "calibrate/seed_average.hpp"
#include "calibrate/sensitivity_stages.hpp"
#include "calibrate/sobol_indices.hpp"

namespace tilth {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
/// Rows per packing in one batch: two of them fill the lanes of most processors, and a stop loses
/// no more.
constexpr std::size_t rows_per_packing = 2;

std::vector<SampleRow> design_of(std::size_t num_free, const SensitivityOptions& o) {
  const int d = static_cast<int>(num_free);
  const std::uint64_t seed = o.packings.first_seed;
  std::vector<SampleRow> rows =
      o.method == SensitivityMethod::morris  ? morris_rows(o.num_rows, d, o.levels, seed)
      : o.method == SensitivityMethod::sobol ? saltelli_rows(o.num_rows, d, seed)
                                             : saltelli_base_rows(o.num_rows, d, seed);
  assign_packings(rows, o.packings);
  return rows;
}

// The runs of one row, not yet made: its points, then the repeats of its ends.
void plan_row(const std::vector<Parameter>& parameters, const SampleRow& row, std::size_t row_id,
              std::vector<SampleRun>& runs) {
  const auto last = static_cast<std::size_t>(row.unit.cols() - 1);
  const auto plan = [&](std::size_t point, bool is_repeat, std::uint64_t seed) {
    runs.push_back({row_id,
                    point,
                    is_repeat,
                    false,
                    seed,
                    physical_point(parameters, row.unit.col(static_cast<Eigen::Index>(point))),
                    {}});
  };
  for (std::size_t i = 0; i <= last; ++i) plan(i, false, row.seed);
  if (!row.repeat_seed) return;
  plan(0, true, *row.repeat_seed);
  if (last > 0) plan(last, true, *row.repeat_seed);
}

void evaluate(Evaluator& evaluator, std::span<SampleRun> runs) {
  Eigen::MatrixXd columns(runs.front().parameters.size(), static_cast<Eigen::Index>(runs.size()));
  std::vector<std::uint64_t> seeds;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = runs[i].parameters;
    seeds.push_back(runs[i].seed);
  }
  std::vector<Evaluation> evaluations = evaluator.evaluate(columns, seeds);
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].evaluation = std::move(evaluations[i]);
}

// Runs rows in batches until one run is refused, then drops its row and all behind it.
void run_in_batches(Evaluator& evaluator, const std::vector<Parameter>& parameters,
                    std::size_t batch, StudyRuns& study) {
  const auto is_skipped = [](const SampleRun& run) {
    return run.evaluation.status == EvaluationStatus::skipped;
  };
  std::size_t row = 0;
  while (row < study.rows.size()) {
    const std::size_t first_run = study.runs.size();
    const std::size_t end = std::min(row + batch, study.rows.size());
    for (; row < end; ++row) plan_row(parameters, study.rows[row], row, study.runs);
    evaluate(evaluator, std::span(study.runs).subspan(first_run));
    const auto refused = std::find_if(study.runs.begin() + static_cast<std::ptrdiff_t>(first_run),
                                      study.runs.end(), is_skipped);
    if (refused == study.runs.end()) continue;
    study.rows.resize(refused->row);
    std::erase_if(study.runs, [&](const SampleRun& r) { return r.row >= study.rows.size(); });
    return;
  }
}

void collect_outputs(const std::vector<Target>& targets, StudyRuns& study) {
  const auto n = static_cast<Eigen::Index>(study.rows.size());
  const Eigen::Index num_points = n > 0 ? study.rows.front().unit.cols() : 0;
  study.outputs.assign(targets.size(), {Eigen::MatrixXd::Constant(num_points, n, nan_value),
                                        Eigen::MatrixXd::Constant(2, n, nan_value)});
  for (const SampleRun& run : study.runs) {
    const auto r = static_cast<Eigen::Index>(run.row);
    const auto i = static_cast<Eigen::Index>(run.point);
    if (run.evaluation.status != EvaluationStatus::completed) continue;
    const Eigen::VectorXd features = transformed_features(targets, run.evaluation);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const double y = features[static_cast<Eigen::Index>(k)];
      if (run.is_repeat)
        study.outputs[k].repeats(i == 0 ? 0 : 1, r) = y;
      else
        study.outputs[k].values(i, r) = y;
    }
  }
}

}  // namespace

StudyRuns run_rows(const std::vector<Parameter>& parameters, const std::vector<Target>& targets,
                   const Simulator& simulator, const SensitivityOptions& options) {
  StudyRuns study;
  study.rows = design_of(free_parameters(parameters).size(), options);
  SimulationLedger ledger;
  ledger.max_simulations = options.max_simulations;
  ledger.max_failed_share = 1.0;  // failures never end a study
  ledger.should_stop = options.should_stop;
  ledger.progress = options.progress;
  for (const SampleRow& row : study.rows)
    ledger.num_expected += static_cast<std::size_t>(
        row.unit.cols() + (row.repeat_seed ? std::min<Eigen::Index>(2, row.unit.cols()) : 0));
  begin_stage(ledger, std::string(to_string(options.method)));
  // A value without a logarithm is missing for its own feature alone, as for hold-outs in a fit.
  std::vector<Target> asked = targets;
  for (Target& target : asked) target.holdout = true;
  Evaluator evaluator(simulator, asked, "sensitivity", ledger, TargetScope::all,
                      MissingFeatures::keep);
  run_in_batches(evaluator, parameters,
                 rows_per_packing * static_cast<std::size_t>(options.packings.num_packings), study);
  collect_outputs(targets, study);
  const bool is_cut = study.rows.size() < static_cast<std::size_t>(options.num_rows);
  if (is_cut)
    study.end = ledger.budget_spent ? SensitivityEnd::budget_spent : SensitivityEnd::stopped;
  return study;
}

}  // namespace tilth
