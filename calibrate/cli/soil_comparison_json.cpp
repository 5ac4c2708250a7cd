// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/cli/soil_comparison.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/draught_band.hpp"

namespace tilth {

using Json = nlohmann::ordered_json;

std::string comparison_json(const std::vector<FittedSoil>& soils, const std::string& command) {
  Json list = Json::array(), pairs = Json::array();
  for (const FittedSoil& s : soils) {
    Json parameters = Json::array(), sweep = Json::object();
    for (const FittedSet::Value* v : estimated(s.set))
      parameters.push_back({{"name", v->name},
                            {"value", json_number(v->value)},
                            {"lo95", json_number(v->lo95)},
                            {"hi95", json_number(v->hi95)},
                            {"verdict", v->verdict}});
    if (!s.runs.empty())
      for (const std::string& name : compared_features(s)) {
        const MeanAndSd m = over_packings(s.runs, name);
        sweep[name] = {{"mean", json_number(m.mean)}, {"sd", json_number(m.sd)}};
      }
    Json band = nullptr;
    if (const auto texture = texture_class(s.soil)) {
      const DraughtBand b =
          sweep_draught_band(*texture, s.sweep.sweep.width_m, s.sweep.tool_depth_m, s.sweep.speed_m_per_s);
      band = {{"texture", name_of(*texture)}, {"low_N", b.low_N}, {"middle_N", b.middle_N}, {"high_N", b.high_N}};
    }
    list.push_back({{"soil", s.soil.id},
                    {"provenance", s.set.provenance_sentence},
                    {"fit_exit_code", s.exit_code},
                    {"preview", s.set.preview},
                    {"parameters", parameters},
                    {"sweep", sweep},
                    {"num_packings", s.runs.size()},
                    {"failures", s.failures},
                    {"draught_band_d497", band}});
  }
  for (const PairRow& p : pairs_of(soils))
    pairs.push_back({{"soils", {p.a, p.b}}, {"parameter", p.parameter}, {"difference", p.word}});
  const Json card = {{"schema", "tilth.comparison/1"},
                     {"soils", list},
                     {"differences", pairs},
                     {"reproduction", {{"command", command}, {"tool", tool_json()}, {"solver", solver_version}}}};
  return card.dump(2) + "\n";
}

}  // namespace tilth
