// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/cli/gnuplot.hpp"
#include "calibrate/cli/scale_report.hpp"

namespace tilth {
namespace {

struct Panel {
  std::string label;
  std::string plots;  // of one `plot` command
};

const char* color_of(std::size_t k) { return figure_colors[k % std::size(figure_colors)]; }

std::string ratio_rows(const std::string& name, const std::vector<Drift>& drift) {
  std::vector<std::vector<double>> rows;
  for (const Drift& d : drift)
    rows.push_back({1e3 * d.radius_m, d.over_finest, d.over_finest - d.over_finest_error,
                    d.over_finest + d.over_finest_error});
  return gnuplot_data(name, rows);
}

void add(Panel& panel, const std::string& name, std::size_t k, const std::string& title) {
  panel.plots += fmt::format(
      "{0}${1} using 1:2:3:4 with yerrorbars pt 7 ps 0.8 lc rgb '{2}' {3}, ${1} using 1:2 with lines dt 3 lc rgb '{2}' "
      "notitle",
      panel.plots.empty() ? "" : ", ", name, color_of(k), title);
}

}  // namespace

std::string draw_scale(const std::vector<ScaleResult>& results, const ScaleContext& context,
                       const std::filesystem::path& svg) {
  std::string data;
  Panel share{"dissimilarity [%]", ""}, draught{"draught over finest", ""}, density{"contacts per area over finest", ""};
  double low_mm = 1e9, high_mm = 0.0, tolerance = 0.0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const ScaleResult& r = results[k];
    if (!r.no_study.empty()) continue;
    const ScaleLimit& l = r.study.limit;
    tolerance = l.tolerance;
    low_mm = std::min(low_mm, 1e3 * r.sizes.front().radius_m);
    high_mm = std::max(high_mm, 1e3 * r.sizes.back().radius_m);
    std::vector<std::vector<double>> rows;
    for (const Dissimilarity& d : r.study.sizes)
      rows.push_back({1e3 * d.radius_m, 100 * d.share, 100 * d.lo95, 100 * d.hi95});
    data += gnuplot_data(fmt::format("share{}", k), rows) + ratio_rows(fmt::format("draught{}", k), r.draught) +
            ratio_rows(fmt::format("density{}", k), r.contact_density);
    add(share, fmt::format("share{}", k), k, "title " + gnuplot_quoted(r.series.name));
    if (l.verdict == ScaleVerdict::found)
      share.plots += fmt::format(", {:.6g} * (x - {:.6g}) lc rgb '{}' notitle",
                                 0.1 * std::sqrt(l.slope_squared_per_m2), 1e3 * r.sizes.front().radius_m, color_of(k));
    add(draught, fmt::format("draught{}", k), k, "notitle");
    add(density, fmt::format("density{}", k), k, "notitle");
  }
  if (share.plots.empty()) return "no series has a study to draw";
  share.plots += fmt::format(", {:.6g} dt 2 lc rgb '#888888' title 'tolerance'", 100 * tolerance);
  std::string script = data + gnuplot_header(svg, 460) +
                       fmt::format("set multiplot layout 1,3 title {}\nset xlabel 'radius [mm]'\nset xrange [{:.4g}:{:.4g}]\n",
                                   gnuplot_quoted(std::string(context.preview ? "PREVIEW: " : "") +
                                                  "particle size: difference from the finest, 95 % (left) and standard errors"),
                                   0.92 * low_mm, 1.06 * high_mm);
  bool first = true;
  for (const Panel& p : {share, draught, density}) {
    script += fmt::format("set ylabel '{}'\nset yrange [0:1.1<*]\nplot {}\n", p.label, p.plots);
    if (first) script += "unset key\n";
    first = false;
  }
  return run_gnuplot(script + "unset multiplot\n", svg);
}

}  // namespace tilth
