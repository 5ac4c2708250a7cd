// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/sensitivity_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "calibrate/cli/gnuplot.hpp"

namespace tilth {
namespace {

const char* color_of(std::size_t k) { return figure_colors[k % std::size(figure_colors)]; }

/// Of one kind, by parameter.
std::vector<IndexEstimate> of_kind(const FeatureSensitivity& f, IndexKind kind) {
  std::vector<IndexEstimate> found;
  std::ranges::copy_if(f.indices, std::back_inserter(found),
                       [kind](const IndexEstimate& i) { return i.kind == kind; });
  return found;
}

/// An end of an interval, or the value where there is none.
double end_or(double end, double value) { return std::isfinite(end) ? end : value; }

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.3g} %", 100 * share) : "not measured";
}

std::string title_of(const SensitivitySummary& s, const FeatureSensitivity& f,
                     const SensitivityContext& context) {
  return fmt::format(
      "{}{}: {} (scale: {})\n{}\npacking noise {} of one run's variance, {} of its runs failed",
      context.preview ? "PREVIEW   " : "", context.subject, f.name,
      f.log_transform ? "ln(value)" : "value, SI unit", method_sentence(s),
      percent(f.noise.noise_share), percent(f.failures.share()));
}

std::string morris_script(const SensitivitySummary& s, const FeatureSensitivity& f) {
  const std::vector<IndexEstimate> mu_star = of_kind(f, IndexKind::mu_star);
  const std::vector<IndexEstimate> sigma = of_kind(f, IndexKind::sigma);
  double reach = end_or(f.noise_floor, 0.0);
  std::string blocks, plots;
  for (std::size_t j = 0; j < mu_star.size(); ++j) {
    const IndexEstimate &x = mu_star[j], &y = sigma[j];
    if (!std::isfinite(x.value) || !std::isfinite(y.value)) continue;
    blocks += gnuplot_data(fmt::format("p{}", j),
                           {{x.value, y.value, end_or(x.low95, x.value), end_or(x.high95, x.value),
                             end_or(y.low95, y.value), end_or(y.high95, y.value)}});
    plots += fmt::format(
        ", $p{} using 1:2:3:4:5:6 with xyerrorbars pt {} ps 1.2 lw 1.6 lc rgb '{}' "
        "title {}",
        j, 5 + 2 * (j % 5), color_of(j), gnuplot_quoted(s.free_names[j]));
    reach = std::max({reach, end_or(x.high95, x.value), end_or(y.high95, y.value)});
  }
  if (plots.empty()) return {};
  std::string script =
      blocks +
      fmt::format(
          "set xlabel 'mu_star: mean size of the elementary effects, per unit of the range'\n"
          "set ylabel 'sigma: their scatter (curvature, interactions)'\n"
          "set xrange [0:{0:.6g}]\nset yrange [0:{0:.6g}]\n",
          reach > 0 ? 1.08 * reach : 1.0);
  if (std::isfinite(f.noise_floor))
    script += fmt::format(
        "set object rectangle from 0, graph 0 to {:.6g}, graph 1 fc rgb '#444444' fs transparent "
        "solid 0.12 noborder behind\n",
        f.noise_floor);
  return script +
         "plot x with lines dt 2 lc rgb '#888888' title 'sigma = mu_star', "
         "NaN with boxes fs solid 0.12 lc rgb '#444444' title 'mu_star of packing noise'" +
         plots + "\n";
}

/// Bars of one index at k + shift: middle, value, interval, bounds.
std::vector<std::vector<double>> bars_of(const std::vector<IndexEstimate>& indices, double shift,
                                         bool bounds) {
  std::vector<std::vector<double>> rows;
  for (std::size_t j = 0; j < indices.size(); ++j) {
    const IndexEstimate& i = indices[j];
    if (!std::isfinite(i.value) || (bounds && !std::isfinite(i.bound_low))) continue;
    const double low = bounds ? i.bound_low : end_or(i.low95, i.value);
    const double high = bounds ? i.bound_high : end_or(i.high95, i.value);
    rows.push_back({static_cast<double>(j) + shift, i.value, low, high});
  }
  return rows;
}

std::string bar_plot(const std::string& name, const char* color, const std::string& label) {
  return fmt::format(
      "${0} using 1:2:(0.3) with boxes fs solid 0.55 lc rgb '{1}' title {2}, "
      "${0} using 1:3:(0):($4-$3) with vectors heads size screen 0.006,90 lw 1.6 lc rgb '#222222' "
      "notitle",
      name, color, gnuplot_quoted(label));
}

std::string sobol_script(const SensitivitySummary& s, const FeatureSensitivity& f) {
  const std::vector<IndexEstimate> first = of_kind(f, IndexKind::first_order);
  const std::vector<IndexEstimate> total = of_kind(f, IndexKind::total);
  const auto first_bars = bars_of(first, -0.17, false), total_bars = bars_of(total, 0.17, false);
  if (first_bars.empty() || total_bars.empty()) return {};
  std::string blocks = gnuplot_data("first", first_bars) + gnuplot_data("total", total_bars);
  std::string plots = bar_plot("first", color_of(0), "S, first order") + ", " +
                      bar_plot("total", color_of(1), "ST, total");
  auto bounds = bars_of(first, -0.09, true);
  for (auto& row : bars_of(total, 0.25, true)) bounds.push_back(row);
  if (!bounds.empty()) {
    blocks += gnuplot_data("bounds", bounds);
    plots +=
        ", $bounds using 1:3:(0):($4-$3) with vectors heads size screen 0.006,90 lw 1.2 dt 3 lc "
        "rgb '#8f5fbf' title "
        "'bounds of failed runs'";
  }
  std::string tics;
  for (std::size_t j = 0; j < s.free_names.size(); ++j)
    tics += fmt::format("{} {}, ", gnuplot_quoted(s.free_names[j]), j);
  const auto d = static_cast<double>(s.free_names.size());
  if (std::isfinite(f.noise.noise_share)) {
    const double share = f.noise.noise_share;
    blocks += gnuplot_data(
        "noise", {{d, share, end_or(f.noise_low95, share), end_or(f.noise_high95, share)}});
    plots += ", " + bar_plot("noise", "#777777", "packing noise, of one run's variance");
  }
  tics += fmt::format("{} {}", gnuplot_quoted("packing noise"), d);
  return blocks +
         fmt::format(
             "set xtics ({}) {}\nset ylabel 'share of the variance due to parameters'\n"
             "set xrange [-0.6:{:.2f}]\nset yrange [*<0:1.05<*]\nset xzeroaxis lt 1 lc rgb "
             "'#444444'\nplot {}\n",
             tics, s.free_names.size() > 4 ? "rotate by -20" : "", d + 0.6, plots);
}

std::string file_stem(const SensitivitySummary& s, const std::string& feature) {
  std::string stem = s.options.method == SensitivityMethod::morris  ? "morris_"
                     : s.options.method == SensitivityMethod::sobol ? "sobol_"
                                                                    : "emulator_";
  for (const char c : feature)
    stem += std::isalnum(static_cast<unsigned char>(c)) || c == '.' ? c : '_';
  return stem;
}

}  // namespace

std::string draw_feature(const SensitivitySummary& s, const FeatureSensitivity& f,
                         const SensitivityContext& context, const std::filesystem::path& svg) {
  const std::string body =
      s.options.method == SensitivityMethod::morris ? morris_script(s, f) : sobol_script(s, f);
  if (body.empty()) return f.name + ": there is no index to draw";
  return run_gnuplot(gnuplot_header(svg, 620) +
                         fmt::format("set title {}\n", gnuplot_quoted(title_of(s, f, context))) +
                         body,
                     svg);
}

std::vector<std::string> draw_sensitivity(const SensitivitySummary& s,
                                          const SensitivityContext& context,
                                          const std::filesystem::path& run_folder) {
  std::vector<std::string> missing;
  for (const FeatureSensitivity& f : s.features) {
    if (!f.no_indices.empty()) {
      missing.push_back(f.name + ": " + f.no_indices);
      continue;
    }
    const std::string why =
        draw_feature(s, f, context, run_folder / "figures" / (file_stem(s, f.name) + ".svg"));
    if (!why.empty()) missing.push_back(why);
  }
  return missing;
}

}  // namespace tilth
