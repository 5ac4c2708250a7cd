// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/fit_config.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

ParameterOverride read_override(JsonObjectReader& entry) {
  ParameterOverride change;
  change.pointer = entry.pointer();
  change.name = entry.required_text("name").value_or("");
  change.lower = entry.optional_number("lower");
  change.upper = entry.optional_number("upper");
  change.start = entry.optional_number("start");
  change.log_scale = entry.optional_flag("log_scale");
  change.estimate = entry.optional_flag("estimate");
  change.value = entry.optional_number("value");
  if (entry.has("tied_to"))
    change.tied_to = entry.text("tied_to", "");
  else
    entry.text("tied_to", "");  // known, though absent
  entry.finish();
  const bool estimated = change.estimate.value_or(false);
  if (change.value && (change.start || change.tied_to || estimated)) {
    entry.problem("value", "holds the parameter: start, tied_to and estimate true contradict it");
  }
  if (change.tied_to && !change.tied_to->empty() && estimated) {
    entry.problem("tied_to", "a tied parameter cannot be estimated");
  }
  return change;
}

void change_parameter(const ParameterOverride& change, SoilParameter& parameter,
                      std::vector<std::string>& problems) {
  if (change.lower) parameter.lower = *change.lower;
  if (change.upper) parameter.upper = *change.upper;
  if (change.start) parameter.nominal = *change.start;
  if (change.log_scale) parameter.log_scale = *change.log_scale;
  if (change.estimate) parameter.estimate = *change.estimate;
  if (change.estimate.value_or(false)) parameter.tied_to.reset();
  if (change.value) {
    parameter.nominal = *change.value;
    parameter.estimate = false;
    parameter.tied_to.reset();
  }
  if (change.tied_to) {
    parameter.tied_to = parse_tie(*change.tied_to);
    parameter.estimate = parameter.estimate && !parameter.tied_to;
    if (!parameter.tied_to && !change.tied_to->empty()) {
      problems.push_back(fmt::format("tied_to = '{}': must read like 1.5*bond_tensile_strength_Pa",
                                     *change.tied_to));
    }
  }
  const bool held = !parameter.estimate && !change.lower && !change.upper;
  if (held) parameter.lower = std::min(parameter.lower, parameter.nominal);
  if (held) parameter.upper = std::max(parameter.upper, parameter.nominal);
  parameter.role = parameter.estimate ? "calibrated" : "fixed";
}

bool matches(const SoilTarget& target, const std::string& wanted) {
  return wanted == target.test_id || wanted == target.test_id + "/" + target.observable_id ||
         wanted == label(target);
}

}  // namespace

FitConfig read_fit_config(JsonObjectReader& object) {
  FitConfig config;
  for (JsonObjectReader& entry : object.objects("parameters")) {
    config.parameters.push_back(read_override(entry));
  }
  config.holdout = object.texts("holdout");
  return config;
}

void apply_fit_config(const FitConfig& config, const std::string& file, SoilData& soil,
                      std::vector<std::string>& problems, const SoilVocabulary& vocabulary) {
  std::vector<std::string> ids;
  for (const SoilParameter& parameter : soil.parameters) ids.push_back(parameter.id);
  for (const ParameterOverride& change : config.parameters) {
    const auto place = std::find(ids.begin(), ids.end(), change.name);
    std::vector<std::string> found;
    if (place == ids.end()) {
      if (!change.name.empty())
        found.push_back(unknown_name_sentence("parameter", change.name, ids));
    } else {
      SoilParameter& parameter = soil.parameters[static_cast<std::size_t>(place - ids.begin())];
      change_parameter(change, parameter, found);
      const auto more = parameter_problems(parameter, vocabulary.parameter(parameter.id));
      found.insert(found.end(), more.begin(), more.end());
    }
    for (const auto& sentence : found) {
      problems.push_back(fmt::format("{}: {}: {}", file, change.pointer, sentence));
    }
  }
  for (const auto& [index, sentence] : tie_problems(soil.parameters)) {
    problems.push_back(fmt::format("{}: {}: {}", file, soil.parameters[index].id, sentence));
  }
  std::vector<std::string> labels;
  for (const SoilTarget& target : soil.targets) labels.push_back(label(target));
  for (const std::string& wanted : config.holdout) {
    bool found = false;
    for (SoilTarget& target : soil.targets) {
      if (!matches(target, wanted)) continue;
      target.holdout = true;
      found = true;
    }
    if (!found) {
      problems.push_back(file + ": /holdout: " + unknown_name_sentence("target", wanted, labels));
    }
  }
}

}  // namespace tilth
