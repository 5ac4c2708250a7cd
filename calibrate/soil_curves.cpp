// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// curves.csv: measured curves of a soil, checked row by row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calibrate/csv_table.hpp"
#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

std::vector<std::string> known_tests(const SoilVocabulary& vocabulary) {
  std::vector<std::string> ids;
  for (const KnownCurve& c : vocabulary.curves) ids.push_back(c.test_id);
  return ids;
}

CsvColumns columns_of(const SoilVocabulary& vocabulary) {
  CsvColumns columns{{"testId", "conditionId"}, {}};
  for (const KnownCurve& curve : vocabulary.curves)
    for (const KnownCurveColumn& c : curve.columns)
      if (std::ranges::find(columns.optional, c.name) == columns.optional.end())
        columns.optional.push_back(c.name);
  return columns;
}

MeasuredCurve& curve_of(std::vector<MeasuredCurve>& curves, const KnownCurve& known,
                        const std::string& condition_id, std::size_t line) {
  for (MeasuredCurve& c : curves)
    if (c.test_id == known.test_id && c.condition_id == condition_id) return c;
  MeasuredCurve fresh{known.test_id, condition_id, {}, {}, {}};
  for (const KnownCurveColumn& c : known.columns) fresh.columns.push_back(c.name);
  fresh.line = line;
  curves.push_back(std::move(fresh));
  return curves.back();
}

/// The first mistake of a kind in a curve speaks for the others.
struct Repeated {
  std::size_t line = 0;
  std::string sentence;
  int count = 0;
};

class CurveProblems {
 public:
  CurveProblems(std::string file, std::vector<std::string>& problems)
      : file_(std::move(file)), problems_(problems) {}

  void add(const std::string& kind, std::size_t line, const std::string& sentence) {
    Repeated& r = found_[kind];
    if (r.count++ > 0) return;
    r.line = line;
    r.sentence = sentence;
  }
  void report() const {
    for (const auto& [kind, r] : found_) {
      const std::string more =
          r.count > 1 ? fmt::format(" (and {} more rows of this curve)", r.count - 1) : "";
      problems_.push_back(fmt::format("{}:{}: {}{}", file_, r.line, r.sentence, more));
    }
  }

 private:
  std::string file_;
  std::vector<std::string>& problems_;
  std::map<std::string, Repeated> found_;
};

void check_row(const KnownCurve& known, const MeasuredCurve& curve, const std::vector<double>& row,
               std::size_t line, CurveProblems& problems) {
  for (std::size_t k = 0; k < row.size(); ++k) {
    const KnownCurveColumn& c = known.columns[k];
    if (row[k] >= c.plausible_lower && row[k] <= c.plausible_upper) continue;
    problems.add(curve.condition_id + c.name, line,
                 fmt::format("{} = {:.6g}: not plausible for soil, must be in [{:.6g}, {:.6g}]{}",
                             c.name, row[k], c.plausible_lower, c.plausible_upper,
                             unit_hint(c.name, row[k], c.plausible_lower, c.plausible_upper)));
  }
  if (curve.rows.empty() || row.front() > curve.rows.back().front()) return;
  problems.add(curve.condition_id + "order", line,
               fmt::format("{} = {:.6g} after {:.6g}: must increase from row to row (leave out "
                           "unloading and repeated readings)",
                           known.columns.front().name, row.front(), curve.rows.back().front()));
}

/// The condition exists, gives what the test is held at, and the curve agrees with it.
void check_condition(const SoilData& soil, const KnownCurve& known, const MeasuredCurve& curve,
                     const std::string& where, std::vector<std::string>& problems) {
  const TestCondition* condition = soil.condition(curve.condition_id);
  if (condition == nullptr) {
    std::vector<std::string> ids;
    for (const TestCondition& c : soil.conditions) ids.push_back(c.id);
    problems.push_back(where + unknown_name_sentence("conditionId", curve.condition_id, ids) +
                       " (conditions.csv)");
    return;
  }
  const auto held = condition->number(known.held_at);
  if (!held) {
    problems.push_back(where + fmt::format("a curve of {} needs {} with one number in condition "
                                           "'{}' (conditions.csv:{})",
                                           curve.test_id, known.held_at, condition->id,
                                           condition->line));
    return;
  }
  const auto column = std::ranges::find(curve.columns, known.held_column) - curve.columns.begin();
  const double first = curve.rows.front()[static_cast<std::size_t>(column)];
  if (std::abs(first / *held - 1) <= 0.25) return;
  problems.push_back(where + fmt::format("{} begins at {:.6g} where {} of condition '{}' is {:.6g}: "
                                         "they must agree within 25 %",
                                         known.held_column, first, known.held_at, condition->id,
                                         *held));
}

}  // namespace

std::vector<MeasuredCurve> read_curves(const std::filesystem::path& file, const SoilData& soil,
                                       const SoilVocabulary& vocabulary,
                                       std::vector<std::string>& problems) {
  std::vector<MeasuredCurve> curves;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return curves;
  const CsvTable table = read_csv(file, columns_of(vocabulary), problems);
  const std::vector<std::string> tests = known_tests(vocabulary);
  CurveProblems repeated(file.string(), problems);
  for (const CsvRow& record : table.rows) {
    CsvRowReader row(table, record, problems);
    const std::string test = row.choice("testId", "testId with curves", tests);
    const std::string condition_id = row.text("conditionId");
    const auto known = std::ranges::find(vocabulary.curves, test, &KnownCurve::test_id);
    if (known == vocabulary.curves.end() || condition_id.empty()) continue;
    std::vector<double> numbers;
    for (const KnownCurveColumn& c : known->columns)
      if (const auto number = row.number(c.name)) numbers.push_back(*number);
    if (numbers.size() != known->columns.size()) continue;
    MeasuredCurve& curve = curve_of(curves, *known, condition_id, row.line());
    check_row(*known, curve, numbers, row.line(), repeated);
    curve.rows.push_back(std::move(numbers));
  }
  repeated.report();
  for (const MeasuredCurve& curve : curves) {
    const auto known = std::ranges::find(vocabulary.curves, curve.test_id, &KnownCurve::test_id);
    check_condition(soil, *known, curve, fmt::format("{}:{}: ", file.string(), curve.line), problems);
  }
  return curves;
}

}  // namespace tilth
