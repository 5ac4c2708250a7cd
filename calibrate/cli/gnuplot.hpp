// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The parts every gnuplot script of a run folder is made of.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tilth {

/// The colours of all figures, in order of use.
inline constexpr const char* figure_colors[] = {"#1b6ca8", "#d1495b", "#3d8b37",
                                                "#8f5fbf", "#c77d0a", "#444444"};

/// In double quotes, as gnuplot reads it.
std::string gnuplot_quoted(const std::string& text);

/// Terminal, grid, and a key in a margin of its own below the axis. Underscores are subscripts in
/// gnuplot's enhanced text; file and parameter names are not, so it is off.
std::string gnuplot_header(const std::filesystem::path& svg, int height);

/// A named block of numbers, one row per line.
std::string gnuplot_data(const std::string& name, const std::vector<std::vector<double>>& rows);

/// Runs the script. @return empty, or why there is no figure (gnuplot absent or failed)
std::string run_gnuplot(const std::string& script, const std::filesystem::path& svg);

}  // namespace tilth
