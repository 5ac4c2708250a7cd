// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include <cmath>

#include "calibrate/sensitivity_report.hpp"

namespace tilth {
namespace {

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string();
}

std::string quoted_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' ? ' ' : c;
  }
  return out + "\"";
}

std::string_view status_word(const SampleRun& run) {
  switch (run.evaluation.status) {
    case EvaluationStatus::completed:
      return run.has_failed() ? "partial" : "completed";
    case EvaluationStatus::failed:
      return "failed";
    case EvaluationStatus::skipped:
      return "skipped";
  }
  return "";
}

std::string index_line(const SensitivitySummary& s, const FeatureSensitivity& f,
                       const IndexEstimate& i) {
  const bool is_morris = s.options.method == SensitivityMethod::morris;
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                     quoted_cell(f.name), f.log_transform ? "ln" : "linear",
                     to_string(s.options.method), is_morris ? std::to_string(s.options.levels) : "",
                     s.num_rows, to_string(i.kind), s.free_names[i.parameter],
                     i.kind == IndexKind::second_order ? s.free_names[i.other] : "", cell(i.value),
                     cell(i.low95), cell(i.high95), cell(i.bound_low), cell(i.bound_high),
                     i.num_values, cell(f.noise.noise_share), cell(f.noise_floor),
                     cell(f.failures.share()), to_string(f.failures.verdict), cell(f.emulator.q2));
}

}  // namespace

std::string sensitivity_csv(const SensitivitySummary& s, const SensitivityContext& context) {
  std::string text =
      "feature,scale,method,levels,num_rows,index,parameter,other_parameter,value,low95,high95,"
      "bound_low,bound_high,num_values,noise_share,noise_floor,failed_share,failures,emulator_q2,"
      "preview\n";
  for (const FeatureSensitivity& f : s.features)
    for (const IndexEstimate& i : f.indices)
      text += index_line(s, f, i) + (context.preview ? ",PREVIEW\n" : ",\n");
  return text;
}

std::string samples_csv(const SensitivitySummary& s, const std::vector<Parameter>& parameters,
                        const SensitivityContext& context) {
  std::string text = "row,point,is_repeat,packing_seed,status";
  for (const Parameter& p : parameters) text += "," + p.name;
  for (const FeatureSensitivity& f : s.features) text += "," + quoted_cell(f.name);
  text += ",message,preview\n";
  for (const SampleRun& run : s.runs) {
    text += fmt::format("{},{},{},{},{}", run.row, run.point, run.is_repeat ? 1 : 0, run.seed,
                        status_word(run));
    for (const double v : run.parameters) text += "," + cell(v);
    const bool has_features = run.evaluation.status == EvaluationStatus::completed;
    for (std::size_t k = 0; k < s.features.size(); ++k)
      text += "," + (has_features ? cell(run.evaluation.features[static_cast<Eigen::Index>(k)])
                                  : std::string());
    text += "," + quoted_cell(run.evaluation.message) + (context.preview ? ",PREVIEW\n" : ",\n");
  }
  return text;
}

}  // namespace tilth
