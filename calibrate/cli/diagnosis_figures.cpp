// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calibrate/cli/diagnosis_report.hpp"
#include "calibrate/cli/gnuplot.hpp"
#include "calibrate/diagnosis/gap_location.hpp"

namespace tilth {
namespace {

namespace fs = std::filesystem;

/// Labels of rows, the first at the top.
std::string row_labels(const std::vector<std::string>& labels) {
  std::string text = "set ytics (";
  for (std::size_t k = 0; k < labels.size(); ++k)
    text += fmt::format("{}{} {}", k ? ", " : "", gnuplot_quoted(labels[k]), labels.size() - k);
  return text + ")\n";
}

double row_of(std::size_t k, std::size_t num) { return static_cast<double>(num - k); }

/// Upper end of an axis of rows or columns.
double end_of(std::size_t num, double margin) { return static_cast<double>(num) + margin; }

int height_of(std::size_t num_rows) { return 190 + 20 * static_cast<int>(num_rows); }

std::string draw(const std::string& script, const fs::path& svg) {
  const std::string why = run_gnuplot(script, svg);
  return why.empty() ? "" : svg.filename().string() + ": " + why;
}

/// What the best baseline leaves, statistic by statistic, with the share the first contender explains.
std::string draw_residuals(const DiagnosisResult& r, std::size_t s, const fs::path& svg) {
  const SoilCase& soil = r.soils[s];
  const AnalysedSoil a = analysed(soil.evidence);
  const Eigen::VectorXd z = standardised_residuals(soil.evidence.model, a.residual, a.noise.total());
  std::vector<std::string> labels;
  std::vector<std::vector<double>> rows, after;
  const auto num = static_cast<std::size_t>(z.size());
  const bool has_contender = soil.models.size() > 1 && soil.models[1].refit.is_usable;
  for (std::size_t k = 0; k < num; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    labels.push_back(soil.evidence.model.statistics[k].name);
    rows.push_back({std::isfinite(z[i]) ? z[i] : 0.0, row_of(k, num)});
    const Eigen::Index at = soil.fitted[k];
    if (has_contender)
      after.push_back({soil.models[1].refit.residual[at] / std::sqrt(soil.covariance(at, at)), row_of(k, num)});
  }
  double far = 3.5;
  for (const auto& row : rows) far = std::max(far, std::abs(row[0]) + 0.5);
  std::string script = gnuplot_header(svg, height_of(num)) + gnuplot_data("before", rows);
  if (has_contender) script += gnuplot_data("after", after);
  script += row_labels(labels) + fmt::format("set xrange [-{0:.2f}:{0:.2f}]\nset yrange [0.3:{1}]\n", far, end_of(num, 0.7));
  script += fmt::format("set title {}\nset xlabel {}\n", gnuplot_quoted(soil.campaign.means.id + ": measured minus simulated"),
                        gnuplot_quoted("standard deviations (band: 2)"));
  script += fmt::format("set object 1 rectangle from -2, graph 0 to 2, graph 1 fillcolor rgb '#eeeeee' fillstyle solid noborder behind\n"
                        "plot $before using 1:2 with points pointtype 7 pointsize 0.7 linecolor rgb '{}' title 'best baseline'",
                        figure_colors[0]);
  if (has_contender)
    script += fmt::format(", $after using 1:2 with points pointtype 6 pointsize 0.9 linecolor rgb '{}' title {}", figure_colors[1],
                          gnuplot_quoted(fmt::format("refitted with {}", fmt::join(soil.models[1].effects, ", "))));
  return draw(script + "\n", svg);
}

/// Probability of every explanation.
std::string draw_probabilities(const DiagnosisResult& r, const fs::path& svg) {
  std::vector<std::pair<double, std::string>> bars = {{r.diagnosis.posterior.none, "nothing is missing"},
                                                      {r.diagnosis.posterior.other, "outside the catalogue"}};
  const auto& choices = r.soils.front().choices;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    const double p = r.diagnosis.posterior.inclusion[static_cast<Eigen::Index>(k)];
    if (p > 0.0) bars.emplace_back(p, choices[k].candidate.id);
  }
  std::ranges::stable_sort(bars, std::ranges::greater(), &std::pair<double, std::string>::first);
  if (bars.size() > 12) bars.resize(12);
  std::vector<std::string> labels;
  std::string boxes;
  for (std::size_t k = 0; k < bars.size(); ++k) {
    labels.push_back(bars[k].second);
    const double y = row_of(k, bars.size());
    boxes += fmt::format("set object {} rectangle from 0, {} to {}, {} fillcolor rgb '{}' fillstyle solid noborder\n", k + 1, y - 0.3,
                         bars[k].first, y + 0.3, figure_colors[0]);
  }
  return draw(gnuplot_header(svg, height_of(bars.size())) + row_labels(labels) + boxes +
                  fmt::format("set xrange [0:1]\nset yrange [0.3:{}]\nset xlabel 'probability'\nset title {}\nunset key\n"
                              "set arrow 1 from 0.8, graph 0 to 0.8, graph 1 nohead dashtype 2\nplot -1 notitle\n",
                              end_of(bars.size(), 0.7), gnuplot_quoted("What is missing (line: enough for a name)")),
              svg);
}

/// Gap of baseline and first contender by experiment.
std::string draw_gaps(const DiagnosisResult& r, std::size_t s, const fs::path& svg) {
  const SoilCase& soil = r.soils[s];
  const auto &before = soil.models[0].gaps, &after = soil.models[1].gaps;
  std::vector<std::string> labels;
  std::vector<std::vector<double>> first, second;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const std::string name = before[k].experiment.empty() ? "all" : before[k].experiment;
    labels.push_back(name + (before[k].holdout ? " (held out)" : ""));
    first.push_back({100 * before[k].gap, row_of(k, before.size())});
    second.push_back({100 * after[k].gap, row_of(k, before.size())});
  }
  return draw(gnuplot_header(svg, height_of(labels.size())) + gnuplot_data("before", first) + gnuplot_data("after", second) +
                  row_labels(labels) +
                  fmt::format("set xrange [0:*]\nset yrange [0.3:{}]\nset xlabel 'disagreement beyond noise [%]'\nset title {}\n"
                              "plot $before using 1:2 with points pointtype 7 pointsize 0.8 linecolor rgb '{}' title 'baseline, refitted', "
                              "$after using 1:2 with points pointtype 6 pointsize 1 linecolor rgb '{}' title {}\n",
                              end_of(labels.size(), 0.7), gnuplot_quoted(soil.campaign.means.id + ": gap before and after"),
                              figure_colors[0], figure_colors[1],
                              gnuplot_quoted(fmt::format("with {}", fmt::join(soil.models[1].effects, ", ")))),
              svg);
}

/// Which effects these data cannot tell apart.
std::string draw_look_alikes(const DiagnosisResult& r, std::size_t s, const fs::path& svg) {
  const SoilDiagnosis& d = r.diagnosis.soils[s];
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < d.scores.size(); ++k)
    if (d.scores[k].decision != EffectDecision::not_measurable) shown.push_back(k);
  if (shown.size() < 2) return svg.filename().string() + ": fewer than two effects can be seen";
  std::vector<std::string> labels;
  std::vector<std::vector<double>> cells;
  std::string columns = "set xtics rotate by -60 (";
  for (std::size_t a = 0; a < shown.size(); ++a) {
    const std::string& id = r.soils[s].choices[shown[a]].candidate.id;
    labels.push_back(id);
    columns += fmt::format("{}{} {}", a ? ", " : "", gnuplot_quoted(id), a + 1);
    for (std::size_t b = 0; b < shown.size(); ++b)
      cells.push_back({static_cast<double>(b) + 1, row_of(a, shown.size()),
                       d.look_alikes(static_cast<Eigen::Index>(shown[a]), static_cast<Eigen::Index>(shown[b]))});
  }
  return draw(gnuplot_header(svg, 400 + 24 * static_cast<int>(shown.size())) + gnuplot_data("cells", cells) + row_labels(labels) + columns +
                  fmt::format(")\nset xrange [0.5:{0}]\nset yrange [0.5:{0}]\nset cbrange [-1:1]\nunset key\nunset grid\n"
                              "set bmargin 15\nset palette defined (-1 '{1}', 0 '#ffffff', 1 '{2}')\nset title {3}\nset cblabel 'cosine of the fingerprints, 1: cannot be told apart'\n"
                              "plot $cells using 1:2:3 with image pixels\n",
                              end_of(shown.size(), 0.5), figure_colors[1], figure_colors[0],
                              gnuplot_quoted(d.soil + ": look-alikes in these data")),
              svg);
}

}  // namespace

std::vector<std::string> draw_diagnosis(const DiagnosisResult& r, const fs::path& folder) {
  std::vector<std::string> missing;
  const auto note = [&missing](const std::string& why) {
    if (!why.empty()) missing.push_back(why);
  };
  if (r.diagnosis.soils.size() != r.soils.size() || r.soils.empty()) return missing;
  fs::create_directories(folder);
  if (r.diagnosis.posterior.inclusion.size() > 0) note(draw_probabilities(r, folder / "probabilities.svg"));
  for (std::size_t s = 0; s < r.soils.size(); ++s) {
    const std::string stem = r.soils.size() > 1 ? r.soils[s].campaign.means.id + "_" : "";
    note(draw_residuals(r, s, folder / (stem + "residuals.svg")));
    note(draw_look_alikes(r, s, folder / (stem + "look_alikes.svg")));
    const auto& models = r.soils[s].models;
    if (models.size() > 1 && models[0].refit.is_usable && models[1].refit.is_usable)
      note(draw_gaps(r, s, folder / (stem + "gaps.svg")));
  }
  return missing;
}

}  // namespace tilth
