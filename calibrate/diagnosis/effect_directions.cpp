// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/effect_directions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/config_error.hpp"
#include "calibrate/csv_table.hpp"

namespace tilth {
namespace {

constexpr double max_level = 3.0;

// Unconfined compression, Brazilian test, direct shear, oedometer, cone, repose, draught, tracers;
// then what further experiments would add.
const std::vector<std::string>& measure_names() {
  static const std::vector<std::string> names = {"ucs_modulus",
                                                 "ucs_peak",
                                                 "ucs_strain_at_peak",
                                                 "ucs_drop",
                                                 "ucs_fast_peak",
                                                 "bt_strength",
                                                 "bt_size_effect",
                                                 "bt_scatter",
                                                 "ds_peak_10kPa",
                                                 "ds_peak_100kPa",
                                                 "ds_residual_10kPa",
                                                 "ds_residual_100kPa",
                                                 "ds_dilation",
                                                 "oed_strain_25kPa",
                                                 "oed_strain_200kPa",
                                                 "oed_unload_ratio",
                                                 "cpt_5cm",
                                                 "cpt_20cm",
                                                 "aor_angle",
                                                 "dr_draught",
                                                 "dr_speed_slope",
                                                 "dr_depth_slope",
                                                 "dr_vertical",
                                                 "tr_displacement",
                                                 "extra_size_halving",
                                                 "extra_steel_shear_10kPa",
                                                 "extra_steel_shear_50kPa",
                                                 "extra_steel_shear_100kPa",
                                                 "extra_ucs_10x_rate",
                                                 "extra_cone_pull_out",
                                                 "extra_bt_scatter_15",
                                                 "extra_ds_rotated_cut",
                                                 "extra_second_unload"};
  return names;
}

Eigen::VectorXi levels_of(CsvRowReader& reader) {
  Eigen::VectorXi levels = Eigen::VectorXi::Zero(static_cast<Eigen::Index>(measure_names().size()));
  for (Eigen::Index i = 0; i < levels.size(); ++i) {
    const std::string& name = measure_names()[static_cast<std::size_t>(i)];
    const auto value = reader.number(name);
    if (!value) continue;
    if (std::abs(*value) > max_level || std::round(*value) != *value)
      reader.problem(fmt::format("{} = {}: must be a whole number in [-3, 3]", name, *value));
    else
      levels[i] = static_cast<int>(*value);
  }
  return levels;
}

DirectionRow row_of(CsvRowReader& reader) {
  static const std::vector<std::string> kinds = {"effect", "parameter"};
  static const std::vector<std::string> signs = {"positive", "free"};
  DirectionRow row;
  row.id = reader.text("id");
  row.short_name = reader.optional_text("short");
  row.is_parameter = reader.choice("kind", "kind", kinds) == kinds[1];
  row.sign =
      reader.choice("sign", "sign", signs) == signs[1] ? EffectSign::free : EffectSign::positive;
  row.levels = levels_of(reader);
  row.provenance = reader.text("provenance");
  row.source = reader.text("source");
  return row;
}

}  // namespace

Eigen::Index DirectionTable::measure(const std::string& name) const {
  const auto found = std::ranges::find(measures, name);
  return found == measures.end() ? -1 : found - measures.begin();
}

DirectionTable read_effect_directions(const std::filesystem::path& file) {
  CsvColumns columns{{"id", "short", "kind", "sign", "provenance", "source"}, {}};
  columns.required.insert(columns.required.end(), measure_names().begin(), measure_names().end());
  std::vector<std::string> problems;
  const CsvTable csv = read_csv(file, columns, problems);
  DirectionTable table{measure_names(), {}};
  for (const CsvRow& line : csv.rows) {
    CsvRowReader reader(csv, line, problems);
    const DirectionRow row = row_of(reader);
    if (std::ranges::find(table.rows, row.id, &DirectionRow::id) != table.rows.end())
      reader.problem(fmt::format("id '{}' stands here twice", row.id));
    table.rows.push_back(row);
  }
  if (!problems.empty()) throw ConfigError(std::move(problems));
  return table;
}

}  // namespace tilth
