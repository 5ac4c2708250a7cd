// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/scale_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "calibrate/cli/scale_groups.hpp"

namespace tilth {
namespace {

double mm(double m) { return 1e3 * m; }

std::string width_over(const ScaleResult& r, double radius_m) {
  return fmt::format("{:.3g}", r.series.config.sweep.width_m / radius_m);
}

struct Interval {
  double low = 0.0, high = 0.0;
};

/// Ends of a measure of the limit over all series; nothing where one of them is open.
template <class Ends>
std::string agreement(const char* measure, const std::vector<const ScaleResult*>& found, Ends ends) {
  bool all_overlap = true;
  std::string list;
  for (std::size_t a = 0; a < found.size(); ++a) {
    const Interval i = ends(*found[a]);
    list += fmt::format("{}{} {:.3g} to {:.3g}", a ? ", " : "", found[a]->series.name, i.low, i.high);
    for (std::size_t b = 0; b < a; ++b) {
      const Interval j = ends(*found[b]);
      all_overlap = all_overlap && i.low <= j.high && j.low <= i.high;
    }
  }
  return fmt::format("{}: the limits {} ({})", measure,
                     all_overlap ? "are compatible, their intervals overlap" : "differ beyond their intervals",
                     list);
}

void add_sizes(const ScaleResult& r, std::string& text) {
  text += fmt::format("  {:>9} {:>9} {:>8} {:>8} {:>9} {:>15} {:>9} {:>16} {:>14} {:>9} {:>14}\n", "radius",
                      "particles", "packings", "width/r", "dissim.", "95 %", "scatter", "draught", "over finest",
                      "contacts", "over finest");
  text += fmt::format("  {:>9} {:>9} {:>8} {:>8} {:>9} {:>15} {:>9} {:>16} {:>14} {:>9} {:>14}\n", "[mm]", "", "", "",
                      "[%]", "[%]", "[%]", "[N]", "", "[1/m2]", "");
  for (std::size_t k = 0; k < r.study.sizes.size(); ++k) {
    const Dissimilarity& d = r.study.sizes[k];
    const Drift &draught = r.draught[k], &density = r.contact_density[k];
    text += fmt::format(
        "  {:>9.4g} {:>9} {:>8} {:>8} {:>9} {:>15} {:>9} {:>16} {:>14} {:>9.0f} {:>14}\n", mm(d.radius_m),
        r.sizes[k].num_particles, r.sizes[k].runs.size(), width_over(r, d.radius_m),
        k ? fmt::format("{:.1f}", 100 * d.share) : "-",
        k ? fmt::format("{:.1f} to {:.1f}", 100 * d.lo95, 100 * d.hi95) : "-",
        k ? fmt::format("{:.1f}", 100 * d.scatter) : "-", fmt::format("{:.0f} (sd {:.0f})", draught.mean, draught.sd),
        fmt::format("{:.2f} ± {:.2f}", draught.over_finest, draught.over_finest_error), density.mean,
        fmt::format("{:.2f} ± {:.2f}", density.over_finest, density.over_finest_error));
  }
}

void add_groups(const ScaleResult& r, std::string& text) {
  text += fmt::format("\n[[Similarity]] of {}: only the particles grow, from {:.4g} to {:.4g} mm\n", r.series.name,
                      mm(r.sizes.front().radius_m), mm(r.sizes.back().radius_m));
  for (const SimilarityGroup& g : similarity_groups(r.series.config, r.series.material, r.sizes.front().radius_m,
                                                    r.sizes.back().radius_m))
    text += fmt::format("  {:<10} {:<25} {:<30} {:>10.4g} {:>10.4g}  {}\n", g.kind, g.name, g.formula, g.finest,
                        g.coarsest, g.kept ? "kept" : "not kept");
}

}  // namespace

std::string scale_sentence(const ScaleResult& r) {
  if (!r.no_study.empty()) return fmt::format("{}: no scale limit: {}", r.series.name, r.no_study);
  const ScaleLimit& l = r.study.limit;
  const double finest_mm = mm(r.sizes.front().radius_m), coarsest_mm = mm(r.sizes.back().radius_m);
  const std::string what = fmt::format("keep tracer displacement within {:.3g} % of that at {:.4g} mm",
                                       100 * l.tolerance, finest_mm);
  switch (l.verdict) {
    case ScaleVerdict::found: {
      const std::string beyond = mm(l.radius_m) > coarsest_mm
                                     ? fmt::format("; beyond the largest size that was run, {:.4g} mm", coarsest_mm)
                                     : "";
      return fmt::format("{}: particles of up to {:.3g} mm radius (tool width / {}) {} (95 %: {:.3g} to {:.3g} mm{})",
                         r.series.name, mm(l.radius_m), width_over(r, l.radius_m), what, mm(l.lo95_m),
                         mm(l.hi95_m.value_or(0.0)), beyond);
    }
    case ScaleVerdict::all_within:
      return fmt::format("{}: all particles that were run, up to {:.4g} mm radius (tool width / {}), {}; no growth of the "
                         "difference with size is significant",
                         r.series.name, coarsest_mm, width_over(r, r.sizes.back().radius_m), what);
    case ScaleVerdict::undecided: break;
  }
  return fmt::format("{}: undecided: particles of up to {:.3g} mm radius (tool width / {}) {} at 95 %; above, the scatter "
                     "between packings hides whether they do. Use more packings",
                     r.series.name, mm(l.lo95_m), width_over(r, l.lo95_m), what);
}

std::vector<std::string> cause_sentences(const std::vector<ScaleResult>& results) {
  std::vector<const ScaleResult*> found;
  for (const ScaleResult& r : results)
    if (r.no_study.empty() && r.study.limit.verdict == ScaleVerdict::found) found.push_back(&r);
  if (found.size() < 2)
    return {"what the limit follows cannot be told: fewer than two series have one"};
  return {agreement("radius [mm]", found,
                    [](const ScaleResult& r) {
                      return Interval{mm(r.study.limit.lo95_m), mm(*r.study.limit.hi95_m)};
                    }),
          agreement("tool width over radius", found,
                    [](const ScaleResult& r) {
                      const double width_m = r.series.config.sweep.width_m;
                      return Interval{width_m / *r.study.limit.hi95_m, width_m / r.study.limit.lo95_m};
                    }),
          agreement("contacts on the tool [1/m2]", found, [](const ScaleResult& r) {
            return Interval{r.density_lo95, r.density_hi95};
          })};
}

std::string scale_report_text(const std::vector<ScaleResult>& results, const ScaleContext& context) {
  std::string text;
  if (context.preview)
    text += "PREVIEW (--quick): coarse aggregates and few packings; do not use these limits\n";
  for (const ScaleResult& r : results) text += scale_sentence(r) + "\n";
  text += fmt::format("values: {}\n", context.values);
  for (const ScaleResult& r : results) {
    text += fmt::format("\n[[{}]] tool {:.4g} mm wide at {:.4g} mm and {:.3g} m/s; {} tracer sites (both sides of the path as one)\n",
                        r.series.name, mm(r.series.config.sweep.width_m), mm(r.series.config.tool_depth_m),
                        r.series.config.speed_m_per_s, r.num_sites);
    if (r.no_study.empty()) add_sizes(r, text);
    if (const double misfit = r.study.limit.misfit; r.no_study.empty() && std::isfinite(misfit))
      text += fmt::format("  line through the finest size: chi-square {:.3g} for {} degrees of freedom\n", misfit,
                          r.study.sizes.size() - 2);
    for (const auto& sizes : {r.sizes, r.left_out})
      for (const ScaleSize& size : sizes)
        for (const std::string& why : size.failures)
          text += fmt::format("  failed at {:.4g} mm: {}\n", mm(size.radius_m), why);
    for (const ScaleSize& size : r.left_out)
      text += fmt::format("  left out: {:.4g} mm, {} of its packings completed\n", mm(size.radius_m), size.runs.size());
  }
  text += "\n[[What the limit follows]]\n";
  for (const std::string& sentence : cause_sentences(results)) text += "  " + sentence + "\n";
  for (const ScaleResult& r : results)
    if (r.sizes.size() > 1) {
      add_groups(r, text);
      break;
    }
  text +=
      "\ndissim.: |difference of mean displacement from the finest size| / |its displacement|, forward, outward, upward at all sites, "
      "less what\nthe packings' scatter adds; scatter: what equal displacements would show. Limit: finest + tolerance / "
      "slope of a line through 0.\n";
  return text + fmt::format("reproduce: {}\n", context.command);
}

std::string scale_csv(const std::vector<ScaleResult>& results) {
  std::string text =
      "series,soil,radius_m,num_particles,num_packings,num_failed,tool_width_over_radius,dissimilarity,dissimilarity_lo95,"
      "dissimilarity_hi95,scatter,draught_N,draught_sd_N,contact_density_per_m2,contact_density_sd_per_m2\n";
  for (const ScaleResult& r : results) {
    if (!r.no_study.empty()) continue;
    for (std::size_t k = 0; k < r.sizes.size(); ++k) {
      const Dissimilarity& d = r.study.sizes[k];
      text += fmt::format("{},{},{:g},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n",
                          r.series.name, r.series.soil_id, d.radius_m, r.sizes[k].num_particles, r.sizes[k].runs.size(),
                          r.sizes[k].failures.size(), r.series.config.sweep.width_m / d.radius_m, d.share, d.lo95,
                          d.hi95, d.scatter, r.draught[k].mean, r.draught[k].sd, r.contact_density[k].mean,
                          r.contact_density[k].sd);
    }
  }
  return text;
}

}  // namespace tilth
