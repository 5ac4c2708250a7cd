// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A comma-separated table with a header line, read strictly: every problem names file and line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tilth {

/// The columns a table must have and may have; any other column is a problem.
struct CsvColumns {
  std::vector<std::string> required;
  std::vector<std::string> optional;
};

struct CsvRow {
  std::size_t line = 0;             ///< line of the file on which the record begins, from 1
  std::vector<std::string> fields;  ///< one per column of CsvTable::columns, outer blanks removed
};

struct CsvTable {
  std::filesystem::path file;
  std::vector<std::string> columns;  ///< as in the header line
  std::vector<CsvRow> rows;          ///< rows with a wrong number of fields are left out (reported)

  /// Position of a column; empty when the table does not have it.
  std::optional<std::size_t> column(std::string_view name) const;
};

/// Reads RFC 4180 text: quotes, doubled quotes, commas and line breaks inside quotes, LF or CRLF,
/// an optional byte-order mark. Blank lines are skipped.
///
/// @param problems  gets one sentence per mistake: file missing, open quote, wrong number of
/// fields,
///                  unknown (with the nearest known name), repeated or missing column
CsvTable read_csv(const std::filesystem::path& file, const CsvColumns& columns,
                  std::vector<std::string>& problems);

/// The same from text already in memory; `file` is used in messages only.
CsvTable parse_csv(std::string_view text, const std::filesystem::path& file,
                   const CsvColumns& columns, std::vector<std::string>& problems);

/// Typed access to one row; each getter adds a sentence "<file>:<line>: ..." for what is wrong.
///
/// A required column the table lacks was reported with the header, so it is silent here.
class CsvRowReader {
 public:
  CsvRowReader(const CsvTable& table, const CsvRow& row, std::vector<std::string>& problems)
      : table_(table), row_(row), problems_(problems) {}

  std::string text(std::string_view column);              ///< must not be empty
  std::string optional_text(std::string_view column);     ///< "" when empty or absent
  std::optional<double> number(std::string_view column);  ///< must be a finite number
  std::optional<double> optional_number(std::string_view column);
  std::vector<double> optional_numbers(std::string_view column);  ///< finite, ';' between them
  std::optional<bool> flag(std::string_view column);              ///< 0 or 1
  /// One of `allowed`; `what` names the kind of word in the message ("provenance").
  std::string choice(std::string_view column, std::string_view what,
                     std::span<const std::string> allowed);

  void problem(std::string_view sentence);  ///< adds "<file>:<line>: <sentence>"
  std::size_t line() const { return row_.line; }

 private:
  std::string_view field(std::string_view column, bool* present) const;
  std::optional<double> parsed(std::string_view column, std::string_view word);

  const CsvTable& table_;
  const CsvRow& row_;
  std::vector<std::string>& problems_;
};

/// A finite decimal number that fills the whole word ("1e-3", "+2.5"); empty otherwise.
/// "nan", "inf" and numbers beyond the range of double are refused.
std::optional<double> parse_finite_number(std::string_view word);

}  // namespace tilth
