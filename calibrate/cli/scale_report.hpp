// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a scale study says: sentences, table, JSON, CSV and figure.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/scale_series.hpp"

namespace tilth {

struct ScaleContext {
  std::string values;    ///< "nominal values", or the fit they come from
  std::string command;   ///< reproduces the study
  bool preview = false;
  std::vector<std::filesystem::path> inputs;
};

/// "loamy_sand: particles of up to 14 mm radius (tool width / 18) keep tracer displacement within 15 % of that at
/// 8 mm (95 %: 11 to 19 mm)", or why no such sentence can be said.
std::string scale_sentence(const ScaleResult& result);

/// One sentence per measure (radius, width over radius, contact density): do the limits of the series agree in it?
/// Empty for fewer than two series with a limit, then a sentence that says so.
std::vector<std::string> cause_sentences(const std::vector<ScaleResult>& results);

/// scale_report.txt
std::string scale_report_text(const std::vector<ScaleResult>& results, const ScaleContext& context);

/// scale.json, schema "tilth.scale/1".
std::string scale_json(const std::vector<ScaleResult>& results, const ScaleContext& context);

/// What makes one study different from another, beside its series.
struct ScaleSettings {
  std::vector<double> radii_m;
  int num_packings = 0;
  double tolerance = 0.0;
  std::uint64_t seed = 0;
  bool preview = false;
};

/// config.json, for --resume.
std::string scale_config_json(const std::vector<ScaleSeries>& series, const ScaleSettings& settings);

/// scale.csv: one row per series and size.
std::string scale_csv(const std::vector<ScaleResult>& results);

/// Dissimilarity, draught and contact density over the radius. @return empty, or why there is no figure
std::string draw_scale(const std::vector<ScaleResult>& results, const ScaleContext& context,
                       const std::filesystem::path& svg);

}  // namespace tilth
