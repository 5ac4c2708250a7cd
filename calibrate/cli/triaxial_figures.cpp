// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/triaxial_figures.hpp"

#include <fmt/format.h>

#include "calibrate/cli/figures.hpp"

namespace tilth {
namespace {

constexpr int measured_color = 5;  // dark grey

}  // namespace

Curve triaxial_curve(const std::vector<std::vector<double>>& rows) {
  Curve curve{"", {"axial_strain", "stress_ratio", "volumetric_strain"}, {}};
  for (const std::vector<double>& row : rows)
    curve.rows.push_back({row[0], 3 * (row[2] - row[3]) / (row[2] + 2 * row[3]), row[1]});
  return curve;
}

std::vector<std::string> draw_triaxial(const SoilData& soil, const std::string& condition_id,
                                       bool holdout, const std::vector<SimulatedTriaxial>& simulated,
                                       const std::filesystem::path& stem) {
  const TestCondition* condition = soil.condition(condition_id);
  std::string state = condition_id;
  if (condition) {
    if (const auto p = condition->number("cell_pressure_Pa")) state += fmt::format(", {:.0f} kPa", *p / 1e3);
    if (const auto d = condition->number("relative_density"))
      state += fmt::format(", relative density {:.0f} %", 100 * *d);
  }
  CurveFigure figure{.title = fmt::format("{}: drained triaxial {}{}", soil.name, state,
                                          holdout ? " (held out)" : ""),
                     .x_label = "axial strain (%)",
                     .y_label = "stress ratio q/p",
                     .x_column = 0,
                     .y_column = 1,
                     .x_scale = 100,
                     .y_scale = 1,
                     .y_from_zero = true,
                     .series = {},
                     .marks = {}};
  for (const SimulatedTriaxial& s : simulated)
    figure.series.push_back({s.label, s.color, triaxial_curve(s.curve.rows)});
  if (const MeasuredCurve* measured = soil.curve("drained_triaxial", condition_id))
    figure.series.push_back({"measured", measured_color, triaxial_curve(measured->rows)});
  std::vector<std::string> missing;
  const auto draw = [&](const std::string& what) {
    const std::filesystem::path svg = stem.string() + "_" + what + ".svg";
    if (const std::string why = draw_curves(figure, svg); !why.empty())
      missing.push_back(fmt::format("no figure {}: {}", svg.filename().string(), why));
  };
  draw("stress_ratio");
  figure.y_label = "volumetric strain (%), dilation negative";
  figure.y_column = 2;
  figure.y_scale = 100;
  figure.y_from_zero = false;
  draw("volumetric_strain");
  return missing;
}

}  // namespace tilth
