// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <nlohmann/json.hpp>

#include "calibrate/cli/export_source.hpp"
#include "calibrate/cli/tool_info.hpp"

namespace tilth {
namespace {

using Json = nlohmann::ordered_json;

/// NaN is not JSON: null where a number is not known.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::string export_json(const ExportSource& source) {
  Json out;
  out["schema"] = "tilth.export/1";
  out["tool"] = {{"name", "tilth"}, {"version", tool_version}, {"commit", tool_commit}};
  out["inputs"] = {{{"path", "fit.json"}, {"sha256", source.card_sha256}}};
  out["soil"] = source.set.soil_id;
  out["seed"] = source.set.seed;
  out["status"] = source.set.status;
  out["preview"] = source.set.preview;
  out["provenance"] = source.set.provenance_sentence;
  out["about"] = about_lines(source);
  out["parameters"] = Json::array();
  for (const ExportRow& row : export_rows(source))
    out["parameters"].push_back({{"name", row.name},
                                 {"value", number(row.value)},
                                 {"unit", row.unit},
                                 {"lo95", number(row.lo95)},
                                 {"hi95", number(row.hi95)},
                                 {"role", row.role},
                                 {"verdict", row.verdict}});
  return out.dump(2) + "\n";
}

}  // namespace tilth
