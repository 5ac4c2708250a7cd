// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/export_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "calibrate/cli/file_hash.hpp"
#include "calibrate/cli/tool_info.hpp"

namespace tilth {
namespace {

std::string number_or_nothing(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

/// A comma or quote inside a field is quoted.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

ExportSource read_export_source(const std::filesystem::path& card_or_folder) {
  ExportSource source{read_fit_card(card_or_folder), ""};
  source.card_sha256 = sha256_of_file(
      std::filesystem::is_directory(card_or_folder) ? card_or_folder / "fit.json" : card_or_folder);
  return source;
}

std::string unit_of(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> units[] = {
      {"_kg_per_m3", "kg/m^3"}, {"_Pa", "Pa"}, {"_rad", "rad"}, {"_m", "m"}};
  for (const auto& [ending, unit] : units)
    if (name.ends_with(ending)) return std::string(unit);
  return "1";
}

std::vector<ExportRow> export_rows(const ExportSource& source) {
  std::vector<ExportRow> rows;
  for (const FittedSet::Value& p : source.set.parameters)
    rows.push_back({p.name, p.value, unit_of(p.name), p.lo95, p.hi95, p.role, p.verdict});
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  SoilMaterial material = source.set.material;
  SoilEffects none;
  const std::vector<Field> null_effects = fields(none);
  for (const Field& f : fields(material)) {
    const bool listed =
        std::ranges::any_of(rows, [&](const ExportRow& row) { return row.name == f.name; });
    const Field* null_effect = find_field(null_effects, f.name);  // an effect that does nothing is no parameter
    if (!listed && !(null_effect && field_text(*null_effect) == field_text(f)))
      rows.push_back({std::string(f.name), *std::get<double*>(f.value), unit_of(f.name), unknown,
                      unknown, "not varied", ""});
  }
  return rows;
}

std::vector<std::string> about_lines(const ExportSource& source) {
  const FittedSet& set = source.set;
  std::vector<std::string> lines = {
      fmt::format("Micro-parameters of bonded soil aggregates (DEM), written by calibrate export, "
                  "tilth {} ({})",
                  tool_version, tool_commit),
      fmt::format("Fit: soil {}, seed {}, status {}, fit.json sha256 {}", set.soil_id, set.seed,
                  set.status.empty() ? "not stated" : set.status, source.card_sha256),
      fmt::format("Provenance: {}",
                  set.provenance_sentence.empty() ? "not stated" : set.provenance_sentence)};
  if (set.preview) lines.push_back("PREVIEW: a --quick fit of few runs; not for use");
  for (const std::string& warning : set.warnings)
    lines.push_back(fmt::format("Warning: {}", warning));
  if (!set.valid_for.empty()) lines.push_back(fmt::format("Valid for: {}", set.valid_for));
  if (!set.not_calibrated_for.empty())
    lines.push_back(fmt::format("Not calibrated for: {}", set.not_calibrated_for));
  if (set.particle_radius_m > 0)
    lines.push_back(
        fmt::format("Fitted with grains of mean radius {:.4g} m; moduli and strengths, "
                    "not stiffnesses per contact, carry over to other sizes",
                    set.particle_radius_m));
  lines.push_back("SI units; lo95, hi95: 95 % interval where the data fix the value");
  return lines;
}

std::string row_sentence(const ExportRow& row) {
  std::string text = fmt::format("{} = {:.6g}", row.name, row.value);
  if (row.unit != "1") text += " " + row.unit;
  if (std::isfinite(row.lo95) && std::isfinite(row.hi95))
    text += fmt::format(", 95 % {:.4g} to {:.4g}", row.lo95, row.hi95);
  if (!row.role.empty()) text += ", " + row.role;
  if (!row.verdict.empty()) text += ", " + row.verdict;
  return text;
}

std::string export_csv(const ExportSource& source) {
  std::string text;
  for (const std::string& line : about_lines(source)) text += "# " + line + "\n";
  text += "name,value,unit,lo95,hi95,role,verdict\n";
  for (const ExportRow& row : export_rows(source))
    text += fmt::format("{},{},{},{},{},{},{}\n", csv_field(row.name), row.value, row.unit,
                        number_or_nothing(row.lo95), number_or_nothing(row.hi95),
                        csv_field(row.role), csv_field(row.verdict));
  return text;
}

}  // namespace tilth
