// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/sensitivity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

#include "calibrate/sensitivity_stages.hpp"

namespace tilth {
namespace {

void count_runs(SensitivitySummary& summary) {
  std::set<std::pair<std::uint64_t, std::vector<double>>> seen;
  for (SampleRun& run : summary.runs) {
    run.is_known = !seen.insert({run.seed, {run.parameters.begin(), run.parameters.end()}}).second;
    if (run.is_known) continue;
    ++summary.num_runs;
    if (run.has_failed()) ++summary.num_failed;
  }
}

}  // namespace

bool SampleRun::has_failed() const {
  return evaluation.status == EvaluationStatus::failed || !evaluation.message.empty();
}

bool SensitivitySummary::has_indices() const {
  return std::ranges::any_of(features, [](const FeatureSensitivity& f) {
    return f.no_indices.empty() && !f.indices.empty();
  });
}

double SensitivitySummary::widest_interval() const {
  double widest = std::numeric_limits<double>::quiet_NaN();
  for (const FeatureSensitivity& f : features)
    for (const IndexEstimate& index : f.indices)
      if (index.kind == IndexKind::first_order || index.kind == IndexKind::total)
        widest = std::fmax(widest, index.high95 - index.low95);
  return widest;
}

SensitivitySummary run_sensitivity(const std::vector<Parameter>& parameters,
                                   const std::vector<Target>& targets, const Simulator& simulator,
                                   const SensitivityOptions& options) {
  assert(problems(parameters, options).empty());
  StudyRuns study = run_rows(parameters, targets, simulator, options);
  SensitivitySummary summary;
  summary.options = options;
  summary.end = study.end;
  summary.num_rows = static_cast<int>(study.rows.size());
  for (const std::size_t j : free_parameters(parameters))
    summary.free_names.push_back(parameters[j].name);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    FeatureSensitivity feature;
    feature.name = targets[k].name;
    feature.log_transform = targets[k].log_transform;
    feature.holdout = targets[k].holdout;
    feature.no_indices = "no row was finished";
    if (!study.rows.empty()) {
      const auto analyse =
          options.method == SensitivityMethod::emulator ? analyse_emulator : analyse_rows;
      analyse(study.rows, study.outputs[k], options, feature);
    }
    summary.features.push_back(std::move(feature));
  }
  summary.runs = std::move(study.runs);
  count_runs(summary);
  return summary;
}

}  // namespace tilth
