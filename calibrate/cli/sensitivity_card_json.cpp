// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause

#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/cli/sensitivity_card.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/strict_json.hpp"

namespace tilth {
namespace {

using Json = nlohmann::ordered_json;

Json index_json(const SensitivitySummary& s, const IndexEstimate& i) {
  Json entry = {{"index", std::string(to_string(i.kind))},
                {"parameter", s.free_names[i.parameter]}};
  if (i.kind == IndexKind::second_order) entry["other_parameter"] = s.free_names[i.other];
  entry["value"] = json_number(i.value);
  entry["lo95"] = json_number(i.low95);
  entry["hi95"] = json_number(i.high95);
  entry["bound_low"] = json_number(i.bound_low);
  entry["bound_high"] = json_number(i.bound_high);
  entry["num_values"] = i.num_values;
  return entry;
}

Json failures_json(const SensitivitySummary& s, const FailurePattern& p) {
  Json parameters = Json::array();
  for (std::size_t j = 0; j < p.parameters.size(); ++j)
    parameters.push_back({{"parameter", s.free_names[j]},
                          {"p_value", p.parameters[j].p_value},
                          {"share_low_third", json_number(p.parameters[j].shares[0])},
                          {"share_middle_third", json_number(p.parameters[j].shares[1])},
                          {"share_high_third", json_number(p.parameters[j].shares[2])}});
  return {{"num_points", p.num_runs},
          {"num_failed", p.num_failed},
          {"share", p.share()},
          {"verdict", std::string(to_string(p.verdict))},
          {"parameters", parameters}};
}

Json noise_json(const FeatureSensitivity& f) {
  return {{"share_of_one_run", json_number(f.noise.noise_share)},
          {"lo95", json_number(f.noise_low95)},
          {"hi95", json_number(f.noise_high95)},
          {"variance_shared", json_number(f.noise.shared)},
          {"variance_independent", json_number(f.noise.independent)},
          {"variance_parameters", json_number(f.noise.parameters)},
          {"variance_total", json_number(f.noise.total)},
          {"mu_star_floor", json_number(f.noise_floor)}};
}

Json feature_json(const SensitivitySummary& s, const FeatureSensitivity& f) {
  Json indices = Json::array();
  for (const IndexEstimate& i : f.indices) indices.push_back(index_json(s, i));
  Json entry = {{"name", f.name},
                {"scale", f.log_transform ? "ln(value)" : "value"},
                {"holdout", f.holdout},
                {"packing_noise", noise_json(f)},
                {"failures", failures_json(s, f.failures)}};
  if (s.options.method == SensitivityMethod::emulator)
    entry["emulator"] = {{"leave_one_out_q2", json_number(f.emulator.q2)},
                         {"leave_one_out_rms", json_number(f.emulator.rms)}};
  if (!f.no_indices.empty()) entry["no_indices_because"] = f.no_indices;
  entry["indices"] = indices;
  return entry;
}

Json failed_runs_json(const SensitivitySummary& s, const std::vector<Parameter>& parameters) {
  Json list = Json::array();
  for (const SampleRun& run : s.runs) {
    if (!run.has_failed() || run.is_known) continue;
    Json values = Json::object();
    for (std::size_t k = 0; k < parameters.size(); ++k)
      values[parameters[k].name] = run.parameters[static_cast<Eigen::Index>(k)];
    list.push_back({{"row", run.row},
                    {"point", run.point},
                    {"packing_seed", run.seed},
                    {"message", run.evaluation.message},
                    {"parameters", values}});
  }
  return list;
}

Json study_json(const SensitivitySummary& s) {
  const SensitivityOptions& o = s.options;
  return {{"method", std::string(to_string(o.method))},
          {"description", method_sentence(s)},
          {"samples_asked", o.num_rows},
          {"samples_finished", s.num_rows},
          {"levels", o.levels},
          {"num_packings", o.packings.num_packings},
          {"num_resamples", o.num_resamples},
          {"parameters", s.free_names}};
}

}  // namespace

std::string sensitivity_json(const SensitivitySummary& s, const SensitivityCardContext& c) {
  Json card;
  card["schema"] = "tilth.sensitivity/1";
  card["tool"] = tool_json();
  card["inputs"] = inputs_json(c.inputs);
  card["seed"] = s.options.packings.first_seed;
  card["status"] = std::string(to_string(s.end));
  card["message"] = failure_sentence(s);
  card["soil"] = c.soil_id;
  card["preview"] = c.report.preview;
  if (c.report.preview) card["warning"] = preview_sentence(c.report);
  card["provenance"] = c.report.provenance;
  card["study"] = study_json(s);
  if (!c.tests.empty()) card["study"]["tests"] = c.tests;
  card["advice"] = advice(s);
  card["features"] = Json::array();
  for (const FeatureSensitivity& f : s.features) card["features"].push_back(feature_json(s, f));
  card["cost"] = {{"num_runs", s.num_runs}, {"num_failed", s.num_failed}};
  card["failed_runs"] = failed_runs_json(s, c.parameters);
  card["reproduction"] = {{"command", c.command},
                          {"tolerance", "byte for byte outside reproduction"}};
  return card.dump(2) + "\n";
}

std::string sensitivity_config_json(const SensitivityStudy& study) {
  const SensitivityOptions& o = study.options;
  Json config;
  config["schema"] = "tilth.run/1";
  config["tool"] = tool_json();
  config["soil"] = study.soil.id;
  config["quick"] = study.fidelity == Fidelity::preview;
  config["inputs"] = inputs_json(study.inputs);
  config["sensitivity"] = {{"method", std::string(to_string(o.method))},
                           {"samples", o.num_rows},
                           {"levels", o.levels},
                           {"num_packings", o.packings.num_packings},
                           {"seed", o.packings.first_seed},
                           {"num_resamples", o.num_resamples}};
  if (!study.tests.empty()) config["sensitivity"]["tests"] = study.tests;
  return config.dump(2) + "\n";
}

SavedStudy read_saved_study(const std::filesystem::path& run_folder) {
  std::vector<std::string> problems;
  const JsonDocument document = read_json(run_folder / "sensitivity.json", problems);
  if (!problems.empty()) throw ConfigError(problems);
  JsonObjectReader card(document, problems);
  card.schema("tilth.sensitivity/1");
  SavedStudy saved;
  saved.soil_id = card.required_text("soil").value_or("");
  saved.seed = card.unsigned_integer("seed", 0);
  saved.preview = card.flag("preview", false);
  for (JsonObjectReader& input : card.objects("inputs"))
    saved.inputs.emplace_back(input.text("path", ""), input.text("sha256", ""));
  if (auto study = card.object("study")) {
    saved.method = study->required_text("method").value_or("");
    saved.tests = study->texts("tests");
    saved.num_rows = static_cast<int>(study->integer("samples_asked", 0, 1, 1 << 24));
    saved.levels = static_cast<int>(study->integer("levels", 4, 2, 1 << 20));
    saved.num_packings = static_cast<int>(study->integer("num_packings", 1, 1, 1000));
  } else {
    card.problem("study", "is missing");
  }
  if (!problems.empty()) throw ConfigError(problems);
  return saved;
}

}  // namespace tilth
