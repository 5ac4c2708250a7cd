// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/gnuplot.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace tilth {

std::string gnuplot_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out + "\"";
}

std::string gnuplot_header(const std::filesystem::path& svg, int height) {
  return fmt::format(
      "set terminal svg size 960,{} dynamic noenhanced font 'DejaVu Sans,13' background '#ffffff'\n"
      "set output {}\nset grid lc rgb '#dddddd'\nset border lc rgb '#444444'\n"
      "set key at screen 0.5, screen {:.3f} center horizontal maxrows 2\nset bmargin 6.5\n",
      height, gnuplot_quoted(svg.string()), 24.0 / height);
}

std::string gnuplot_data(const std::string& name, const std::vector<std::vector<double>>& rows) {
  std::string text = fmt::format("${} << EOD\n", name);
  for (const auto& row : rows) {
    for (const double v : row) text += fmt::format("{:.7g} ", v);
    text += '\n';
  }
  return text + "EOD\n";
}

std::string run_gnuplot(const std::string& script, const std::filesystem::path& svg) {
  std::filesystem::create_directories(svg.parent_path());
  FILE* pipe = ::popen("gnuplot 2>/dev/null", "w");
  if (!pipe) return "gnuplot could not be started";
  std::fwrite(script.data(), 1, script.size(), pipe);
  const int status = ::pclose(pipe);
  if (status == 0 && std::filesystem::exists(svg)) return {};
  return "gnuplot is not installed or failed (apt-get install gnuplot-nox)";
}

}  // namespace tilth
