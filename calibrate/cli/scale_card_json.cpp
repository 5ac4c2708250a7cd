// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/cli/scale_groups.hpp"
#include "calibrate/cli/scale_report.hpp"
#include "calibrate/cli/solver_version.hpp"

namespace tilth {
namespace {

using Json = nlohmann::ordered_json;

/// What stays the same over the sizes of a series.
Json series_settings_json(const ScaleSeries& series) {
  SweepTillageConfig config = series.config;
  SoilMaterial material = series.material;
  Json test = fields_json(fields(config));
  test.erase("particle_radius_m");
  test.erase("packing_seed");
  return {{"test", test}, {"material", fields_json(fields(material))}};
}

Json drift_json(const Drift& d) {
  return {{"mean", json_number(d.mean)},
          {"sd", json_number(d.sd)},
          {"over_finest", json_number(d.over_finest)},
          {"over_finest_error", json_number(d.over_finest_error)}};
}

Json limit_json(const ScaleResult& r) {
  const ScaleLimit& l = r.study.limit;
  return {{"verdict", name_of(l.verdict)},
          {"tolerance", l.tolerance},
          {"radius_m", json_number(l.radius_m)},
          {"lo95_m", json_number(l.lo95_m)},
          {"hi95_m", l.hi95_m ? json_number(*l.hi95_m) : Json(nullptr)},
          {"tool_width_over_radius", json_number(r.series.config.sweep.width_m / l.radius_m)},
          {"contact_density_per_m2", json_number(r.density_at_limit)},
          {"contact_density_lo95_per_m2", json_number(r.density_lo95)},
          {"contact_density_hi95_per_m2", json_number(r.density_hi95)},
          {"slope_squared_per_m2", json_number(l.slope_squared_per_m2)},
          {"slope_squared_error_per_m2", json_number(l.slope_squared_error)},
          {"misfit_chi_square", json_number(l.misfit)}};
}

Json series_json(const ScaleResult& r) {
  Json sizes = Json::array(), left_out = Json::array(), groups = Json::array();
  for (std::size_t k = 0; k < r.sizes.size(); ++k) {
    Json size = {{"radius_m", r.sizes[k].radius_m},
                 {"num_particles", r.sizes[k].num_particles},
                 {"num_packings", r.sizes[k].runs.size()},
                 {"failures", r.sizes[k].failures}};
    if (r.no_study.empty()) {
      const Dissimilarity& d = r.study.sizes[k];
      size["dissimilarity"] = {{"share", d.share}, {"lo95", d.lo95}, {"hi95", d.hi95},
                               {"raw", d.raw},     {"scatter", d.scatter}};
      size["draught_N"] = drift_json(r.draught[k]);
      size["contact_density_per_m2"] = drift_json(r.contact_density[k]);
    }
    sizes.push_back(size);
  }
  for (const ScaleSize& size : r.left_out)
    left_out.push_back({{"radius_m", size.radius_m}, {"num_packings", size.runs.size()}, {"failures", size.failures}});
  if (r.sizes.size() > 1)
    for (const SimilarityGroup& g : similarity_groups(r.series.config, r.series.material, r.sizes.front().radius_m,
                                                      r.sizes.back().radius_m))
      groups.push_back({{"kind", g.kind},     {"name", g.name},         {"formula", g.formula},
                        {"finest", g.finest}, {"coarsest", g.coarsest}, {"kept", g.kept}});
  return {{"name", r.series.name},
          {"soil", r.series.soil_id},
          {"sentence", scale_sentence(r)},
          {"num_tracer_sites", r.num_sites},
          {"limit", r.no_study.empty() ? limit_json(r) : Json(nullptr)},
          {"no_limit_because", r.no_study},
          {"sizes", sizes},
          {"left_out", left_out},
          {"similarity", groups},
          {"settings", series_settings_json(r.series)}};
}

}  // namespace

std::string scale_config_json(const std::vector<ScaleSeries>& series, const ScaleSettings& settings) {
  Json list = Json::array();
  for (const ScaleSeries& s : series)
    list.push_back({{"name", s.name}, {"settings", series_settings_json(s)}});
  const Json config = {{"command", "scale"},
                       {"radii_m", settings.radii_m},
                       {"num_packings", settings.num_packings},
                       {"tolerance", settings.tolerance},
                       {"seed", settings.seed},
                       {"preview", settings.preview},
                       {"series", list}};
  return config.dump(2) + "\n";
}

std::string scale_json(const std::vector<ScaleResult>& results, const ScaleContext& context) {
  Json series = Json::array();
  for (const ScaleResult& r : results) series.push_back(series_json(r));
  const Json card = {{"schema", "tilth.scale/1"},
                     {"preview", context.preview},
                     {"provenance", "simulated; nothing here is measured"},
                     {"values", context.values},
                     {"series", series},
                     {"what_the_limit_follows", cause_sentences(results)},
                     {"reproduction",
                      {{"command", context.command},
                       {"tool", tool_json()},
                       {"solver", solver_version},
                       {"inputs", inputs_json(context.inputs)}}}};
  return card.dump(2) + "\n";
}

}  // namespace tilth
