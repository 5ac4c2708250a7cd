// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "calibrate/cli/gnuplot.hpp"
#include "calibrate/cli/sweep_views.hpp"

namespace tilth {
namespace {

using Rows = std::vector<std::vector<double>>;

const Curve* curve_named(const ExperimentResult& r, const std::string& name) {
  const auto found = std::ranges::find(r.curves, name, &Curve::name);
  return found == r.curves.end() || found->rows.empty() ? nullptr : &*found;
}

/// x, z, radius and distance moved [mm] of the aggregates cut by the plane of the tool's path.
Rows cut_aggregates(const BedView& view) {
  Rows rows;
  for (std::size_t i = 0; i < view.position_m.size(); ++i) {
    const Vec3& x = view.position_m[i];
    if (std::abs(x.y()) > view.radius_m[i]) continue;
    rows.push_back(
        {1e3 * x.x(), 1e3 * x.z(), 1e3 * view.radius_m[i], 1e3 * view.displacement_m[i].norm()});
  }
  return rows;
}

/// The tool's triangles seen from the side, as filled polygons apart from each other by empty
/// lines.
std::string side_of_tool(const std::string& name, const BedView& view, double top_m) {
  std::string text = fmt::format("${} << EOD\n", name);
  for (const auto& t : view.tool.triangle) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3& v = view.tool.vertex_m[static_cast<std::size_t>(t[k % 3])];
      text += fmt::format("{:.6g} {:.6g}\n", 1e3 * v.x(), 1e3 * std::min(v.z(), top_m));
    }
    text += '\n';
  }
  return text + "EOD\n";
}

struct Span {
  double low_m = 0.0, high_m = 0.0;
};

Span along_travel(const BedView& view) {
  Span s{view.position_m.front().x(), view.position_m.front().x()};
  for (const Vec3& x : view.position_m) s = {std::min(s.low_m, x.x()), std::max(s.high_m, x.x())};
  return s;
}

/// One side view in a plot of its own.
std::string panel(std::size_t k, const std::string& title, const BedView& view, double top_m) {
  const auto name = [k](const char* what) { return fmt::format("{}{}", what, k); };
  std::string script =
      gnuplot_data(name("cut"), cut_aggregates(view)) + side_of_tool(name("tool"), view, top_m);
  std::map<double, Rows> by_depth;
  for (std::size_t t = 0; t < view.tracer_m.size(); ++t)
    by_depth[view.tracer_depth_m[t]].push_back(
        {1e3 * view.tracer_m[t].x(), 1e3 * view.tracer_m[t].z()});
  std::string tracers;
  std::size_t color = 0;
  for (const auto& [depth_m, rows] : by_depth) {
    const std::string block = fmt::format("depth{}_{}", k, color);
    script += gnuplot_data(block, rows);
    tracers += fmt::format(
        ", ${} using 1:2 with points pt 7 ps 0.55 lc rgb '{}' title 'laid {:.3g} "
        "mm deep'",
        block, figure_colors[color % std::size(figure_colors)], 1e3 * depth_m);
    ++color;
  }
  script += fmt::format(
      "set title {}\nplot ${} using 1:2:3:4 with circles fs solid 0.9 border lc rgb '#777777' "
      "fc palette notitle, ${} using 1:2 with filledcurves closed fs solid 1.0 noborder lc rgb "
      "'#30363d' title 'tool'{}\n",
      gnuplot_quoted(title), name("cut"), name("tool"), tracers);
  return script;
}

}  // namespace

std::string draw_bed(const std::string& title, const BedView& before, const BedView& stopped,
                     const BedView& after, const std::filesystem::path& svg) {
  const Span x = along_travel(before);
  const double top_m = before.surface_m + 0.12;
  std::string script = gnuplot_header(svg, 860);
  script += fmt::format(
      "set multiplot layout 3,1 title {} margins screen 0.08,0.86,0.13,0.92 spacing screen 0.08\n"
      "set size ratio -1\nset xrange [{:.5g}:{:.5g}]\n"
      "set yrange [0:{:.5g}]\nset ylabel 'z (mm)'\nunset key\n"
      "set palette defined (0 '#f3ead7', 0.15 '#e3c48d', 0.5 '#c08a3e', 1 '#6b3e12')\n"
      "set cblabel 'moved (mm)'\nset cbrange [0:300]\n",
      gnuplot_quoted(title), 1e3 * (x.low_m - 0.03), 1e3 * (x.high_m + 0.03), 1e3 * top_m);
  script += panel(0, "settled, cut along the tool's path", before, top_m);
  script += panel(1, "the tool has stopped", stopped, top_m);
  script +=
      "set xlabel 'along the travel (mm)'\n"
      "set key at screen 0.5, screen 0.03 center horizontal maxrows 2\n";
  script += panel(2, "at rest; dots: tracers of all offsets", after, top_m);
  return run_gnuplot(script + "unset multiplot\n", svg);
}

std::string draw_sweep_forces(const std::string& title, const ExperimentResult& r,
                              const std::filesystem::path& svg) {
  const Curve* forces = curve_named(r, "sweep_forces");
  if (!forces) return "there is no curve to draw";
  std::string script = gnuplot_header(svg, 520) + gnuplot_data("forces", forces->rows);
  script += fmt::format(
      "set title {}\nset xlabel 'travel of the nose (m)'\nset ylabel 'force of the "
      "soil on the tool (N)'\nset xzeroaxis\nset xrange [0:*]\n",
      gnuplot_quoted(title));
  if (const double begin_m = r.feature("steady_begin_m"); begin_m > 0)
    script += fmt::format(
        "set object rectangle from {:.5g}, graph 0 to {:.5g}, graph 1 fc rgb '#3d8b37' "
        "fs transparent solid 0.10 noborder behind\n",
        begin_m, r.feature("steady_end_m"));
  const char* names[] = {"draught (shaded: steady window)", "vertical, up", "side, to the left"};
  std::string plot = "set key maxrows 1\nplot ";
  for (std::size_t k = 0; k < std::size(names); ++k)
    plot += fmt::format("{}$forces using 1:{} with lines lw 1.4 lc rgb '{}' title {}",
                        k ? ", " : "", k + 2, figure_colors[k], gnuplot_quoted(names[k]));
  return run_gnuplot(script + plot + "\n", svg);
}

std::string draw_sweep_section(const std::string& title, const ExperimentResult& r,
                               const std::filesystem::path& svg) {
  const Curve* before = curve_named(r, "surface_before");
  const Curve* after = curve_named(r, "surface_after");
  const Curve* means = curve_named(r, "tracer_means");
  if (!before || !after || !means) return "there is no curve to draw";
  std::string script = gnuplot_header(svg, 760) + gnuplot_data("before", before->rows) +
                       gnuplot_data("after", after->rows);
  script += fmt::format(
      "set multiplot layout 2,1 title {}\nset tmargin 2\nset bmargin 5\n"
      "set key outside right top vertical maxrows 10\n"
      "set ylabel 'mean height of the surface (mm)'\nset xlabel 'to the left of the "
      "path (mm)'\nplot $before using ($1*1e3):($2*1e3) with linespoints pt 7 ps 0.5 "
      "lc rgb '{}' title 'before', $after using ($1*1e3):($2*1e3) with linespoints pt "
      "7 ps 0.5 lc rgb '{}' title 'after'\n",
      gnuplot_quoted(title), figure_colors[0], figure_colors[1]);
  std::map<double, Rows> by_depth;
  for (const auto& row : means->rows)
    by_depth[row[0]].push_back({row[1] * 1e3, row[3] * 1e3, row[6] * 1e3});
  script += "set ylabel 'moved forward (mm), bars: one tracer'\nset xzeroaxis\n";
  std::string plot = "plot ";
  std::size_t k = 0;
  for (const auto& [depth_m, rows] : by_depth) {
    script += gnuplot_data(fmt::format("depth{}", k), rows);
    plot += fmt::format(
        "{}$depth{} using 1:2:3 with yerrorlines pt 7 ps 0.6 lc rgb '{}' title '{:.3g} mm "
        "deep'",
        k ? ", " : "", k, figure_colors[k % std::size(figure_colors)], 1e3 * depth_m);
    ++k;
  }
  return run_gnuplot(script + plot + "\nunset multiplot\n", svg);
}

}  // namespace tilth
