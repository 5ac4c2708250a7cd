// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What every export says about the fit it comes from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/cli/fit_card.hpp"

namespace tilth {

/// A card and what identifies it.
struct ExportSource {
  FittedSet set;
  std::string card_sha256;
};

/// One file of an export; the name is relative to its folder.
struct ExportFile {
  std::string name;
  std::string text;
};

/// One number of the set as exported.
struct ExportRow {
  std::string name;
  double value = 0.0;
  std::string unit;               ///< "1" without dimension
  double lo95 = 0.0, hi95 = 0.0;  ///< NaN where unknown
  std::string role, verdict;
};

/// @throws ConfigError of read_fit_card
ExportSource read_export_source(const std::filesystem::path& card_or_folder);

/// SI unit at the end of a name: "bond_modulus_Pa" gives "Pa", "friction" gives "1".
std::string unit_of(std::string_view name);

/// Parameters of the card, then the numbers of the material that the card lists nowhere else.
std::vector<ExportRow> export_rows(const ExportSource& source);

/// What the numbers are, one sentence per line: soil, seed, provenance, warnings, validity.
std::vector<std::string> about_lines(const ExportSource& source);

/// "name = value unit, 95 % lo to hi, role, verdict".
std::string row_sentence(const ExportRow& row);

/// about_lines() and values as JSON, schema "tilth.export/1".
std::string export_json(const ExportSource& source);

/// about_lines() as comment lines, then name,value,unit,lo95,hi95,role,verdict; unknown: empty.
std::string export_csv(const ExportSource& source);

}  // namespace tilth
