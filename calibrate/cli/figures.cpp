// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calibrate/cli/gnuplot.hpp"

namespace tilth {
namespace {

/// More rows than this stand close, with one-line labels.
constexpr std::size_t many_rows = 30;

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

}  // namespace

std::string draw_curves(const CurveFigure& figure, const std::filesystem::path& svg) {
  std::string script = gnuplot_header(svg, 520);
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n",
                        gnuplot_quoted(figure.title), gnuplot_quoted(figure.x_label), gnuplot_quoted(figure.y_label));
  std::vector<std::string> plots;
  for (std::size_t k = 0; k < figure.marks.size(); ++k) {
    const FigureMark& m = figure.marks[k];
    const char* color = figure_colors[(k + 3) % std::size(figure_colors)];
    script += fmt::format(
        "set object rectangle from graph 0, first {:.7g} to graph 1, first {:.7g} "
        "fc rgb '{}' fs transparent solid 0.10 noborder behind\n",
        m.y_low * figure.y_scale, m.y_high * figure.y_scale, color);
    plots.push_back(fmt::format("{:.7g} with lines lw 2 dt 2 lc rgb '{}' title {}",
                                m.y * figure.y_scale, color, gnuplot_quoted(m.label)));
  }
  std::set<int> in_key;
  for (std::size_t k = 0; k < figure.series.size(); ++k) {
    const CurveFigure::Series& s = figure.series[k];
    std::vector<std::vector<double>> rows;
    for (const auto& row : s.curve.rows)
      rows.push_back({row[figure.x_column] * figure.x_scale, row[figure.y_column] * figure.y_scale});
    if (rows.empty()) continue;
    script += gnuplot_data(fmt::format("d{}", k), rows);
    const bool first = in_key.insert(s.color).second;
    plots.push_back(fmt::format("$d{} using 1:2 with lines lw 1.6 lc rgb '{}' {}", k,
                                figure_colors[static_cast<std::size_t>(s.color) % std::size(figure_colors)],
                                first ? "title " + gnuplot_quoted(s.label) : "notitle"));
  }
  if (plots.empty()) return "there is no curve to draw";
  script += figure.y_from_zero ? "set yrange [0:*]\n" : "set yrange [*:*]\nset xzeroaxis\n";
  script += "set xrange [0:*]\nplot ";
  for (std::size_t k = 0; k < plots.size(); ++k) script += (k ? ", " : "") + plots[k];
  return run_gnuplot(script + "\n", svg);
}

namespace {

/// Five marks over a range; a log axis shorter than a decade has none of its own.
std::string five_tics(double from, double to, bool log_scale) {
  std::string tics = "set xtics (";
  for (int k = 0; k < 5; ++k) {
    const double share = k / 4.0;
    const double value = log_scale ? from * std::pow(to / from, share) : from + share * (to - from);
    tics += fmt::format("{}'{:.3g}' {:.7g}", k > 0 ? ", " : "", value, value);
  }
  return tics + ")\n";
}

/// Of the profile at the fitted value: far above 0 where the emulators see a better place elsewhere.
double difference_at_best(const ProfileFigure& figure) {
  const auto nearest = std::ranges::min_element(
      figure.values, {}, [&](double value) { return std::abs(value - figure.best); });
  return figure.chi_square_difference[static_cast<std::size_t>(nearest - figure.values.begin())];
}

}  // namespace

std::string draw_profile_figure(const ProfileFigure& figure, const std::filesystem::path& svg) {
  if (figure.values.empty()) return "there is no profile to draw";
  const double top = std::max(3.0 * figure.level, 1.3 * difference_at_best(figure));
  const std::size_t n = figure.values.size();
  std::size_t first = n, last = 0;
  std::vector<std::vector<double>> curve;
  std::map<std::string, std::vector<std::vector<double>>> marks;
  for (std::size_t i = 0; i < n; ++i) {
    const double difference = figure.chi_square_difference[i];
    curve.push_back({figure.values[i], difference});
    if (!figure.at_bound[i].empty())
      marks[figure.at_bound[i]].push_back({figure.values[i], std::min(difference, 0.98 * top)});
    if (difference > top) continue;
    first = std::min(first, i);
    last = i;
  }
  if (first >= n) return "there is no profile to draw";
  first -= first > 0 ? 1 : 0;
  last += last + 1 < n ? 1 : 0;
  std::string script = gnuplot_header(svg, 520) + gnuplot_data("profile", curve);
  script += fmt::format(
      "set title {}\nset xlabel {}\nset ylabel 'chi-square above the best, the others refitted'\n"
      "{}{}set xrange [{:.7g}:{:.7g}]\nset yrange [0:{:.7g}]\n"
      "set arrow from {:.7g}, graph 0 to {:.7g}, graph 1 nohead dt 3 lc rgb '#444444'\n",
      gnuplot_quoted(figure.title), gnuplot_quoted(figure.x_label), figure.log_x ? "set logscale x\n" : "",
      five_tics(figure.values[first], figure.values[last], figure.log_x), figure.values[first], figure.values[last], top, figure.best, figure.best);
  if (std::isfinite(figure.low) && std::isfinite(figure.high))
    script += fmt::format(
        "set object rectangle from {:.7g}, graph 0 to {:.7g}, graph 1 fc rgb '{}' fs transparent "
        "solid 0.10 noborder behind\n",
        std::max(figure.low, figure.values[first]), std::min(figure.high, figure.values[last]),
        figure_colors[2]);
  std::string plot = fmt::format(
      "plot {:.7g} with lines lw 2 dt 2 lc rgb '{}' title {}, $profile using 1:2 with linespoints "
      "lw 2 pt 7 ps 0.6 lc rgb '{}' title 'profile (shaded: linear 95 % interval)'",
      figure.level, figure_colors[1], gnuplot_quoted(figure.level_label), figure_colors[0]);
  std::size_t k = 0;
  for (const auto& [name, rows] : marks) {
    script += gnuplot_data(fmt::format("mark{}", k), rows);
    plot += fmt::format(", $mark{} using 1:2 with points pt 9 ps 1.6 lc rgb '{}' title {}", k,
                        figure_colors[(k + 3) % std::size(figure_colors)], gnuplot_quoted(name + " at its bound"));
    ++k;
  }
  return run_gnuplot(script + plot + "\n", svg);
}

std::string draw_targets(const std::string& title, const std::vector<TargetRow>& rows,
                         const std::filesystem::path& svg) {
  if (rows.empty()) return "there is no target to draw";
  const int row_height = rows.size() > many_rows ? 20 : 54;
  std::string script = gnuplot_header(svg, 180 + row_height * static_cast<int>(rows.size()));
  std::vector<std::vector<double>> fitted, held;
  std::string tics = "set ytics (";
  double reach = 3;
  std::size_t longest = 0;  // characters of a label in one line
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double y = static_cast<double>(rows.size() - k);
    const TargetRow& r = rows[k];
    const std::string label = rows.size() > many_rows ? one_line(r.label) : r.label;
    if (rows.size() > many_rows) longest = std::max(longest, label.size());
    tics += fmt::format("{}{} {}", k ? ", " : "", gnuplot_quoted(label), y);
    if (!std::isfinite(r.residual)) continue;
    (r.holdout ? held : fitted).push_back({r.residual, y, r.seed_sd});
    reach = std::max(reach, std::abs(r.residual) + r.seed_sd + 0.5);
  }
  script += tics + ")\n";
  script += fmt::format(
      "set title {}\nset xlabel '(simulated - target) / total sigma, bars: one packing'\n"
      "set xrange [{:.3g}:{:.3g}]\nset yrange [0.4:{}]\nset lmargin {}\n"
      "set object rectangle from -1, graph 0 to 1, graph 1 fc rgb '#3d8b37' fs transparent solid "
      "0.10 noborder behind\n"
      "set arrow from 0, graph 0 to 0, graph 1 nohead lc rgb '#444444'\n",
      gnuplot_quoted(title), -reach, reach, static_cast<double>(rows.size()) + 0.6,
      // a character of a label is as wide as 0.78 of those that margins are counted in
      longest > 0 ? static_cast<std::size_t>(0.78 * static_cast<double>(longest)) + 3 : 48);
  std::string plot = "plot ";
  if (!fitted.empty()) {
    script += gnuplot_data("fitted", fitted);
    plot += fmt::format("$fitted using 1:2:3 with xerrorbars pt 7 ps 1 lw 1.6 lc rgb '{}' title "
                        "'fitted target'",
                        figure_colors[0]);
  }
  if (!held.empty()) {
    script += gnuplot_data("held", held);
    plot += fmt::format("{}$held using 1:2:3 with xerrorbars pt 6 ps 1 lw 1.6 lc rgb '{}' title "
                        "'held out (predicted)'",
                        fitted.empty() ? "" : ", ", figure_colors[1]);
  }
  if (fitted.empty() && held.empty()) return "no target was simulated";
  return run_gnuplot(script + plot + "\n", svg);
}

}  // namespace tilth
