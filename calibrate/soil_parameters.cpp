// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// parameters.csv.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "calibrate/csv_table.hpp"
#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

const std::vector<std::string>& prior_words() {
  static const std::vector<std::string> words = {"none", "uniform", "normal", "log_normal"};
  return words;
}

void read_prior(CsvRowReader& row, SoilParameter& parameter) {
  const std::string word = row.choice("prior_type", "prior_type", prior_words());
  const auto& words = prior_words();
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end() || word == "none") return;
  const auto p1 = row.number("prior_p1");
  const auto p2 = row.number("prior_p2");
  if (!p1 || !p2) return;
  parameter.prior = static_cast<PriorKind>(found - words.begin());
  parameter.prior_p1 = *p1;
  parameter.prior_p2 = *p2;
}

/// False when the numbers cannot be judged because one is missing (reported).
bool read_bounds(CsvRowReader& row, SoilParameter& parameter) {
  const auto nominal = row.number("nominal");
  parameter.nominal = nominal.value_or(0.0);
  const auto lower = row.optional_number("lower");
  const auto upper = row.optional_number("upper");
  parameter.lower = lower.value_or(parameter.nominal);
  parameter.upper = upper.value_or(parameter.nominal);
  const bool complete = nominal && (!parameter.estimate || (lower && upper));
  if (nominal && !complete) {
    row.problem(fmt::format("{} is estimated: lower and upper are needed", parameter.id));
  }
  return complete;
}

void read_tie(CsvRowReader& row, SoilParameter& parameter) {
  const std::string text = row.optional_text("tied_to");
  if (text.empty()) return;
  parameter.tied_to = parse_tie(text);
  if (!parameter.tied_to) {
    row.problem(fmt::format("tied_to = '{}': must read like 1.5*bond_tensile_strength_Pa", text));
  }
}

SoilParameter read_parameter(CsvRowReader& row, const SoilVocabulary& vocabulary) {
  static const std::vector<std::string> scales = {"lin", "log10"};
  static const std::vector<std::string> roles = {"calibrated", "fixed"};
  SoilParameter parameter;
  parameter.line = row.line();
  parameter.id = row.text("parameterId");
  const KnownParameter* known = vocabulary.parameter(parameter.id);
  std::string reason;
  if (!has_si_name(parameter.id, &reason)) {
    row.problem("parameterId " + reason);
  } else if (known == nullptr && !parameter.id.empty()) {
    row.problem(unknown_name_sentence("parameterId", parameter.id, vocabulary.parameter_ids()));
  }
  parameter.log_scale = row.choice("scale", "scale", scales) == "log10";
  parameter.estimate = row.flag("estimate").value_or(false);
  const bool has_numbers = read_bounds(row, parameter);
  read_prior(row, parameter);
  parameter.group = row.optional_text("group");
  read_tie(row, parameter);
  parameter.role = row.choice("role", "role", roles);
  const bool contradicts = parameter.role == (parameter.estimate ? "fixed" : "calibrated");
  if (contradicts && !parameter.tied_to) {
    row.problem(fmt::format("{}: estimate {} contradicts role {}", parameter.id,
                            parameter.estimate ? 1 : 0, parameter.role));
  }
  if (!has_numbers) return parameter;
  for (const std::string& sentence : parameter_problems(parameter, known)) row.problem(sentence);
  return parameter;
}

}  // namespace

std::vector<SoilParameter> read_parameters(const std::filesystem::path& file,
                                           const SoilVocabulary& vocabulary,
                                           std::vector<std::string>& problems) {
  const CsvColumns columns{
      {"parameterId", "scale", "lower", "upper", "nominal", "estimate", "prior_type", "role"},
      {"prior_p1", "prior_p2", "group", "tied_to", "note"}};
  const CsvTable table = read_csv(file, columns, problems);
  std::vector<SoilParameter> parameters;
  std::set<std::string> seen;
  for (const CsvRow& record : table.rows) {
    CsvRowReader row(table, record, problems);
    parameters.push_back(read_parameter(row, vocabulary));
    const std::string& id = parameters.back().id;
    if (!id.empty() && !seen.insert(id).second) {
      row.problem(fmt::format("parameterId '{}' occurs twice", id));
    }
  }
  for (const auto& [index, sentence] : tie_problems(parameters)) {
    problems.push_back(fmt::format("{}:{}: {}", file.string(), parameters[index].line, sentence));
  }
  return parameters;
}

}  // namespace tilth
