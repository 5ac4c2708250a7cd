// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/soil_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/cli/gnuplot.hpp"
#include "calibrate/draught_band.hpp"

namespace tilth {
namespace {

const FittedSet::Value* value_named(const FittedSet& set, const std::string& name) {
  const auto found = std::ranges::find(set.parameters, name, &FittedSet::Value::name);
  return found == set.parameters.end() ? nullptr : &*found;
}

}  // namespace

MeanAndSd over_packings(const std::vector<ExperimentResult>& runs, const std::string& feature) {
  const auto n = static_cast<double>(runs.size());
  MeanAndSd m;
  for (const ExperimentResult& r : runs) m.mean += r.feature(feature) / n;
  for (const ExperimentResult& r : runs) m.sd += std::pow(r.feature(feature) - m.mean, 2) / (n - 1);
  m.sd = std::sqrt(m.sd);
  return m;
}

std::vector<std::string> compared_features(const FittedSoil& s) {
  std::vector<std::string> names = {"draught_N", "contact_density_per_m2", "furrow_area_m2", "ridge_area_m2",
                                    "disturbed_area_m2"};
  for (const char* direction : {"forward_displacement_m@", "vertical_displacement_m@"})
    for (const double depth_m : s.sweep.tracer_depth_m) names.push_back(fmt::format("{}{:g}m", direction, depth_m));
  return names;
}

std::vector<const FittedSet::Value*> estimated(const FittedSet& set) {
  std::vector<const FittedSet::Value*> values;
  for (const FittedSet::Value& v : set.parameters)
    if (v.role.starts_with("calibrated")) values.push_back(&v);
  return values;
}

std::vector<PairRow> pairs_of(const std::vector<FittedSoil>& soils) {
  std::vector<PairRow> rows;
  for (std::size_t i = 0; i < soils.size(); ++i)
    for (std::size_t j = i + 1; j < soils.size(); ++j)
      for (const FittedSet::Value* v : estimated(soils[i].set))
        if (const FittedSet::Value* w = value_named(soils[j].set, v->name))
          rows.push_back({soils[i].soil.id, soils[j].soil.id, v->name, difference_word(*v, *w)});
  return rows;
}

void run_sweeps(std::vector<FittedSoil>& soils, Fidelity fidelity, int num_packings, std::uint64_t first_seed,
                const RunContext& context) {
  std::vector<TestRun> runs;
  for (FittedSoil& s : soils) {
    TestConfig config = virtual_test("sweep_tillage", fidelity);
    apply_soil_state(config, s.soil);
    s.sweep = std::get<SweepTillageConfig>(config);
    for (int p = 0; p < num_packings; ++p) {
      set_packing_seed(config, first_seed + static_cast<std::uint64_t>(p));
      runs.push_back({config, "comparison", s.set.material});
    }
  }
  const std::vector<ExperimentResult> results = run_tests(runs, context);
  for (std::size_t k = 0; k < results.size(); ++k) {
    FittedSoil& s = soils[k / static_cast<std::size_t>(num_packings)];
    if (results[k].status == RunStatus::completed)
      s.runs.push_back(results[k]);
    else
      s.failures.push_back(fmt::format("{}: {}", name_of(results[k].status), results[k].message));
  }
}

std::string difference_word(const FittedSet::Value& a, const FittedSet::Value& b) {
  for (const double end : {a.lo95, a.hi95, b.lo95, b.hi95})
    if (!std::isfinite(end)) return "not known";
  return a.hi95 < b.lo95 || b.hi95 < a.lo95 ? "differ" : "not distinguishable";
}

std::string comparison_text(const std::vector<FittedSoil>& soils, const std::string& head) {
  std::string text = head + "\n";
  for (const FittedSoil& s : soils)
    text += fmt::format("{}: {}{}\n", s.soil.id, s.set.provenance_sentence,
                        s.exit_code == 0 ? "" : fmt::format(" (its fit ended with exit code {})", s.exit_code));
  text += "\n[[Parameters]] fitted, 95 % interval, verdict\n";
  for (const FittedSoil& s : soils)
    for (const FittedSet::Value* v : estimated(s.set))
      text += fmt::format("  {:<14} {:<28} {:>11.4g}  [{:.4g}, {:.4g}]  {}\n", s.soil.id, v->name, v->value, v->lo95,
                          v->hi95, v->verdict);
  text += "\n[[Differences]] \"differ\": the 95 % intervals do not overlap\n";
  for (const PairRow& p : pairs_of(soils))
    text += fmt::format("  {:<14} {:<14} {:<28} {}\n", p.a, p.b, p.parameter, p.word);
  text += "\n[[Sweep]] simulated at the fitted values, mean over packings (sd); displacements over the tracers of a depth\n";
  for (const FittedSoil& s : soils) {
    if (s.runs.empty()) {
      text += fmt::format("  {}: no run of the sweep completed\n", s.soil.id);
    } else {
      for (const std::string& name : compared_features(s)) {
        const MeanAndSd m = over_packings(s.runs, name);
        text += fmt::format("  {:<14} {:<34} {:>10.4g} ({:.2g})\n", s.soil.id, name, m.mean, m.sd);
      }
      if (const auto texture = texture_class(s.soil))
        text += fmt::format("  {:<14} {}\n", s.soil.id,
                            draught_sentence(*texture,
                                             sweep_draught_band(*texture, s.sweep.sweep.width_m, s.sweep.tool_depth_m,
                                                                s.sweep.speed_m_per_s),
                                             over_packings(s.runs, "draught_N").mean));
    }
    for (const std::string& why : s.failures) text += fmt::format("  {:<14} failed: {}\n", s.soil.id, why);
  }
  return text;
}

std::string draw_comparison(const std::vector<FittedSoil>& soils, const std::string& title,
                            const std::filesystem::path& svg) {
  std::string data, parameters, depths, tics;
  std::vector<std::string> names;
  for (const FittedSoil& s : soils)
    for (const FittedSet::Value* v : estimated(s.set))
      if (std::ranges::find(names, v->name) == names.end()) names.push_back(v->name);
  for (std::size_t j = 0; j < names.size(); ++j)
    tics += fmt::format("{}{} {}", j ? ", " : "", gnuplot_quoted(names[j]), j);
  for (std::size_t k = 0; k < soils.size(); ++k) {
    const FittedSoil& s = soils[k];
    std::vector<std::vector<double>> rows, moved;
    for (std::size_t j = 0; j < names.size(); ++j) {
      const FittedSet::Value* v = value_named(s.set, names[j]);
      if (!v) continue;
      double log_mean = 0.0, n = 0.0;  // of all soils
      for (const FittedSoil& other : soils)
        if (const FittedSet::Value* w = value_named(other.set, names[j]); w && w->value > 0)
          log_mean += std::log(w->value), n += 1;
      const double middle = std::exp(log_mean / n);
      const double shift = 0.15 * (static_cast<double>(k) - 0.5 * static_cast<double>(soils.size() - 1));
      const auto end = [&](double value) { return std::isfinite(value) ? value / middle : v->value / middle; };
      rows.push_back({static_cast<double>(j) + shift, v->value / middle, end(v->lo95), end(v->hi95)});
    }
    data += gnuplot_data(fmt::format("p{}", k), rows);
    parameters += fmt::format("{}$p{} using 1:2:3:4 with yerrorbars pt 7 ps 0.9 lw 1.5 lc rgb '{}' title {}",
                              k ? ", " : "", k, figure_colors[k % std::size(figure_colors)], gnuplot_quoted(s.soil.id));
    if (s.runs.empty()) continue;
    for (const double depth_m : s.sweep.tracer_depth_m) {
      const MeanAndSd m = over_packings(s.runs, fmt::format("forward_displacement_m@{:g}m", depth_m));
      const double sd = std::isfinite(m.sd) ? m.sd : 0.0;
      moved.push_back({m.mean, -1e3 * depth_m - 0.8 * static_cast<double>(k), m.mean - sd, m.mean + sd});
    }
    data += gnuplot_data(fmt::format("d{}", k), moved);
    depths += fmt::format("{0}$d{1} using 1:2:3:4 with xerrorbars pt 7 ps 0.9 lw 1.5 lc rgb '{2}' notitle, $d{1} using 1:2 "
                          "with lines dt 3 lc rgb '{2}' notitle",
                          depths.empty() ? "" : ", ", k, figure_colors[k % std::size(figure_colors)]);
  }
  if (parameters.empty()) return "no soil has a fitted parameter";
  std::string script = data + gnuplot_header(svg, 460) +
                       fmt::format("set multiplot layout 1,2 title {}\nset xtics ({}) rotate by -12\nset xrange [-0.6:{:.2f}]\n"
                                   "set logscale y\nset ylabel 'over geometric mean of the soils, 95 %'\nplot {}\n",
                                   gnuplot_quoted(title), tics, static_cast<double>(names.size()) - 0.4, parameters);
  if (!depths.empty())
    script += fmt::format("unset key\nunset logscale\nset xtics auto norotate\nset xrange [0:*]\nset xlabel 'forward displacement "
                          "[m], sd over packings'\nset ylabel 'initial depth [mm]'\nplot {}\n",
                          depths);
  return run_gnuplot(script + "unset multiplot\n", svg);
}

}  // namespace tilth
