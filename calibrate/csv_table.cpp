// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "calibrate/nearest_name.hpp"

namespace tilth {
namespace {

std::string_view trimmed(std::string_view word) {
  const auto first = word.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return word.substr(first, word.find_last_not_of(" \t\r") - first + 1);
}

/// Cuts text into records; quotes are resolved, blank lines dropped.
class RecordSplitter {
 public:
  RecordSplitter(std::string_view text, const std::filesystem::path& file,
                 std::vector<std::string>& problems)
      : text_(text), file_(file), problems_(problems) {}

  std::vector<CsvRow> records() {
    while (at_ < text_.size()) {
      CsvRow row = next();
      const bool blank = row.fields.size() == 1 && row.fields.front().empty();
      if (!blank) rows_.push_back(std::move(row));
    }
    return std::move(rows_);
  }

 private:
  CsvRow next() {
    CsvRow row;
    row.line = line_;
    bool more = true;
    while (more) {
      row.fields.push_back(next_field());
      more = at_ < text_.size() && text_[at_] == ',';
      if (more) ++at_;
    }
    if (at_ < text_.size()) ++at_;  // the line break
    ++line_;
    return row;
  }

  std::string next_field() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    if (at_ < text_.size() && text_[at_] == '"') return quoted_field();
    const auto end = std::min(text_.find_first_of(",\n", at_), text_.size());
    const std::string_view word = trimmed(text_.substr(at_, end - at_));
    at_ = end;
    return std::string(word);
  }

  std::string quoted_field() {
    const std::size_t opened_on = line_;
    std::string word;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        const bool doubled = at_ + 1 < text_.size() && text_[at_ + 1] == '"';
        if (!doubled) break;
        ++at_;
      }
      if (text_[at_] == '\n') ++line_;
      word += text_[at_];
    }
    if (at_ >= text_.size()) {
      problems_.push_back(
          fmt::format("{}:{}: a quote (\") is opened and never closed", file_.string(), opened_on));
      return word;
    }
    ++at_;  // the closing quote
    const auto end = std::min(text_.find_first_of(",\n", at_), text_.size());
    if (!trimmed(text_.substr(at_, end - at_)).empty()) {
      problems_.push_back(fmt::format("{}:{}: text after a closing quote; inside quotes write \"\"",
                                      file_.string(), line_));
    }
    at_ = end;
    return word;
  }

  std::string_view text_;
  const std::filesystem::path& file_;
  std::vector<std::string>& problems_;
  std::vector<CsvRow> rows_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void check_header(const CsvTable& table, std::size_t line, const CsvColumns& columns,
                  std::vector<std::string>& problems) {
  const std::string where = fmt::format("{}:{}", table.file.string(), line);
  if (table.columns.size() == 1 && table.columns[0].find(';') != std::string::npos) {
    problems.push_back(where + ": the columns are separated by ';': separate them by ','");
    return;
  }
  std::vector<std::string> known = columns.required;
  known.insert(known.end(), columns.optional.begin(), columns.optional.end());
  std::vector<std::string> seen;
  for (const std::string& name : table.columns) {
    if (!contains(known, name)) {
      problems.push_back(where + ": " + unknown_name_sentence("column", name, known));
    } else if (contains(seen, name)) {
      problems.push_back(fmt::format("{}: column '{}' occurs twice", where, name));
    }
    seen.push_back(name);
  }
  for (const std::string& name : columns.required) {
    if (!contains(table.columns, name)) {
      problems.push_back(fmt::format("{}: column '{}' is missing", where, name));
    }
  }
}

}  // namespace

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

CsvTable parse_csv(std::string_view text, const std::filesystem::path& file,
                   const CsvColumns& columns, std::vector<std::string>& problems) {
  CsvTable table;
  table.file = file;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.substr(0, 3) == byte_order_mark) text.remove_prefix(3);
  std::vector<CsvRow> records = RecordSplitter(text, file, problems).records();
  if (records.empty()) {
    problems.push_back(fmt::format("{}:1: empty: a header line is expected", file.string()));
    return table;
  }
  table.columns = records.front().fields;
  check_header(table, records.front().line, columns, problems);
  for (std::size_t i = 1; i < records.size(); ++i) {
    const std::size_t num_fields = records[i].fields.size();
    if (num_fields == table.columns.size()) {
      table.rows.push_back(std::move(records[i]));
    } else {
      problems.push_back(fmt::format("{}:{}: {} fields, the header has {} columns", file.string(),
                                     records[i].line, num_fields, table.columns.size()));
    }
  }
  return table;
}

CsvTable read_csv(const std::filesystem::path& file, const CsvColumns& columns,
                  std::vector<std::string>& problems) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  const bool opened = !std::filesystem::is_directory(file) && stream.is_open();
  if (opened && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!opened || stream.bad()) {
    problems.push_back(fmt::format("{}: the file is missing or cannot be read", file.string()));
    CsvTable none;
    none.file = file;
    return none;
  }
  return parse_csv(text.str(), file, columns, problems);
}

std::optional<double> parse_finite_number(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  if (!whole || word.empty() || !std::isfinite(number)) return std::nullopt;
  return number;
}

void CsvRowReader::problem(std::string_view sentence) {
  problems_.push_back(fmt::format("{}:{}: {}", table_.file.string(), row_.line, sentence));
}

std::string_view CsvRowReader::field(std::string_view column, bool* present) const {
  const auto position = table_.column(column);
  *present = position.has_value();
  return position ? std::string_view(row_.fields[*position]) : std::string_view();
}

std::optional<double> CsvRowReader::parsed(std::string_view column, std::string_view word) {
  const auto number = parse_finite_number(word);
  if (number) return number;
  std::string sentence = fmt::format("{} = '{}' is not a finite number", column, word);
  const bool comma = word.find(',') != std::string_view::npos;
  problem(comma ? sentence + "; write the decimal point as '.'" : sentence);
  return std::nullopt;
}

std::string CsvRowReader::text(std::string_view column) {
  bool present = false;
  const std::string_view word = field(column, &present);
  if (present && word.empty()) problem(fmt::format("{} is empty", column));
  return std::string(word);
}

std::string CsvRowReader::optional_text(std::string_view column) {
  bool present = false;
  return std::string(field(column, &present));
}

std::optional<double> CsvRowReader::number(std::string_view column) {
  bool present = false;
  const std::string_view word = field(column, &present);
  if (!present) return std::nullopt;
  if (word.empty()) {
    problem(fmt::format("{} is empty: a number is expected", column));
    return std::nullopt;
  }
  return parsed(column, word);
}

std::optional<double> CsvRowReader::optional_number(std::string_view column) {
  bool present = false;
  const std::string_view word = field(column, &present);
  return word.empty() ? std::nullopt : parsed(column, word);
}

std::vector<double> CsvRowReader::optional_numbers(std::string_view column) {
  bool present = false;
  std::string_view words = field(column, &present);
  std::vector<double> numbers;
  while (!words.empty()) {
    const auto end = std::min(words.find(';'), words.size());
    const auto number = parsed(column, trimmed(words.substr(0, end)));
    if (number) numbers.push_back(*number);
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return numbers;
}

std::optional<bool> CsvRowReader::flag(std::string_view column) {
  bool present = false;
  const std::string_view word = field(column, &present);
  if (word == "0" || word == "1") return word == "1";
  if (present) problem(fmt::format("{} = '{}': must be 0 or 1", column, word));
  return std::nullopt;
}

std::string CsvRowReader::choice(std::string_view column, std::string_view what,
                                 std::span<const std::string> allowed) {
  bool present = false;
  const std::string_view word = field(column, &present);
  const bool known = std::find(allowed.begin(), allowed.end(), word) != allowed.end();
  if (present && !known) problem(unknown_name_sentence(what, word, allowed));
  return known ? std::string(word) : std::string();
}

}  // namespace tilth
