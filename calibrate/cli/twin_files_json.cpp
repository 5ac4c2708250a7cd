// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>

#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/cli/twin_files.hpp"

namespace tilth {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string twin_soil_json(const SoilData& soil, const std::string& id) {
  Json state = Json::array();
  for (const StateQuantity& q : soil.state) {
    Json entry = {{"quantity", q.quantity}, {"value", q.value}};
    if (q.sigma) entry["sigma"] = *q.sigma;
    if (q.lower) entry["lower"] = *q.lower;
    if (q.upper) entry["upper"] = *q.upper;
    entry["provenance"] = "synthetic";
    entry["source"] = "calibrate twin";
    entry["locator"] = "state given to the model";
    state.push_back(entry);
  }
  const Json text = {{"schema", "tilth.soil/1"},
                     {"id", id},
                     {"name", "Synthetic specimens"},
                     {"site", "none: made by a model"},
                     {"state", state}};
  return text.dump(2) + "\n";
}

std::string twin_truth_json(const TwinData& twin, const TwinPlan& plan, const std::string& source_soil,
                            const std::string& command) {
  Json effects = Json::array();
  for (const ChosenEffect& e : plan.effects)
    effects.push_back({{"id", e.id}, {"parameter", e.parameter}, {"value", e.value}});
  Json parameters = Json::object();
  for (std::size_t k = 0; k < twin.soil.parameters.size(); ++k) {
    const SoilParameter& p = twin.soil.parameters[k];
    if (p.group != "effect") parameters[p.id] = twin.values[static_cast<Eigen::Index>(k)];
  }
  const Json text = {{"schema", "tilth.truth/1"},
                     {"soil", source_soil},
                     {"effects", effects},
                     {"parameters", parameters},
                     {"noise", {{"specimen_cv", plan.noise.specimen_cv}, {"rig_cv", plan.noise.rig_cv}}},
                     {"num_replicates", plan.num_replicates},
                     {"fidelity", name_of(plan.fidelity)},
                     {"seed", plan.seed},
                     {"lost_specimens", twin.lost},
                     {"reproduction", {{"command", command}, {"tool", tool_json()}, {"solver", solver_version}}}};
  return text.dump(2) + "\n";
}

TwinTruthFile read_twin_truth(const std::filesystem::path& file) {
  std::ifstream in(file);
  const Json text = Json::parse(in, nullptr, false);
  if (text.is_discarded() || text.value("schema", "") != "tilth.truth/1")
    throw ConfigError({file.string() + ": not a tilth.truth/1 file"});
  TwinTruthFile truth;
  for (const Json& e : text.at("effects"))
    truth.effects.push_back({e.at("id"), e.at("parameter"), e.at("value")});
  for (const auto& [name, value] : text.at("parameters").items())
    truth.parameters.emplace_back(name, value.get<double>());
  return truth;
}

}  // namespace tilth
