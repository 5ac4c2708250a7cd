// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Figures of a run, drawn by gnuplot as SVG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/result.hpp"

namespace tilth {

/// A number drawn into a curve plot: a horizontal line at y with a band, or a point at (x, y).
struct FigureMark {
  std::string label;
  double y = 0.0;
  double y_low = 0.0;
  double y_high = 0.0;
};

/// Curves of one kind, one per packing seed, with their targets.
struct CurveFigure {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::size_t x_column = 0;
  std::size_t y_column = 1;
  double x_scale = 1.0;  ///< human units: strain in %, displacement in mm
  double y_scale = 1.0;  ///< stress in kPa
  bool y_from_zero = true;
  struct Series {
    std::string label;
    int color = 0;  ///< seeds of one kind share a colour; only the first of a colour is in the key
    Curve curve;
  };
  std::vector<Series> series;
  std::vector<FigureMark> marks;
};

/// One row of the measured-against-simulated figure, in units of its total sigma.
struct TargetRow {
  std::string label;       ///< with provenance
  double measured = 0.0;   ///< human units, for the label only
  double simulated = 0.0;
  double residual = 0.0;   ///< (simulated - measured) / sigma
  double seed_sd = 0.0;    ///< the same unit
  bool holdout = false;
};

/// The profile of one parameter.
struct ProfileFigure {
  std::string title;
  std::string x_label;
  bool log_x = false;
  double best = 0.0;         ///< fitted value
  double low = 0.0, high = 0.0;  ///< linear 95 % interval, shaded; NaN = none
  double level = 0.0;        ///< 95 % line
  std::string level_label;
  std::vector<double> values;
  std::vector<double> chi_square_difference;
  std::vector<std::string> at_bound;  ///< marked where not empty
};

/// Writes the SVG. Returns an empty text, or why there is no figure (gnuplot absent or failed).
std::string draw_curves(const CurveFigure& figure, const std::filesystem::path& svg);
std::string draw_profile_figure(const ProfileFigure& figure, const std::filesystem::path& svg);
std::string draw_targets(const std::string& title, const std::vector<TargetRow>& rows,
                         const std::filesystem::path& svg);

}  // namespace tilth
