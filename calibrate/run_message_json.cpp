// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/run_message.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tilth {
namespace {

using Json = nlohmann::json;

double number_from(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json identity_json(const RunIdentity& i) {
  return {{"solver", i.solver}, {"test", i.test},   {"condition", i.condition},
          {"seed", i.seed},     {"setup", i.setup}, {"material", i.material}};
}

RunIdentity identity_from(const Json& json) {
  return {json.at("solver"), json.at("test"),  json.at("condition"),
          json.at("seed"),   json.at("setup"), json.at("material")};
}

Json table_json(const NamedTable& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json cells = Json::array();
    for (const double value : row) cells.push_back(number(value));
    rows.push_back(std::move(cells));
  }
  return {{"name", table.name}, {"columns", table.columns}, {"rows", std::move(rows)}};
}

NamedTable table_from(const Json& json) {
  NamedTable table{json.at("name"), json.at("columns"), {}};
  for (const Json& row : json.at("rows")) {
    std::vector<double> values;
    for (const Json& cell : row) values.push_back(number_from(cell));
    table.rows.push_back(std::move(values));
  }
  return table;
}

RunState state_from(const std::string& word) {
  for (const RunState s : {RunState::candidate, RunState::completed, RunState::failed, RunState::abandoned})
    if (word == to_string(s)) return s;
  throw std::runtime_error("unknown state " + word);
}

Json record_json(const RunRecord& r) {
  Json features = Json::array(), curves = Json::array();
  for (const NamedNumber& f : r.features) features.push_back({f.name, number(f.value)});
  for (const NamedTable& c : r.curves) curves.push_back(table_json(c));
  return {{"key", r.key},
          {"identity", identity_json(r.identity)},
          {"state", std::string(to_string(r.state))},
          {"reason", r.reason},
          {"num_tries", r.num_tries},
          {"dt_s", number(r.dt_s)},
          {"num_steps", r.num_steps},
          {"inertial_number", number(r.inertial_number)},
          {"wall_s", number(r.wall_s)},
          {"host", r.host},
          {"features", std::move(features)},
          {"curves", std::move(curves)}};
}

RunRecord record_from(const Json& json) {
  RunRecord r;
  r.key = json.at("key");
  r.identity = identity_from(json.at("identity"));
  r.state = state_from(json.at("state"));
  r.reason = json.at("reason");
  r.num_tries = json.at("num_tries");
  r.dt_s = number_from(json.at("dt_s"));
  r.num_steps = json.at("num_steps");
  r.inertial_number = number_from(json.at("inertial_number"));
  r.wall_s = number_from(json.at("wall_s"));
  r.host = json.at("host");
  for (const Json& f : json.at("features")) r.features.push_back({f.at(0), number_from(f.at(1))});
  for (const Json& c : json.at("curves")) r.curves.push_back(table_from(c));
  return r;
}

Json parsed(const std::string& message, const char* schema) {
  Json json;
  try {
    json = Json::parse(message);
  } catch (const Json::exception& e) {
    throw std::runtime_error(std::string("not a message: ") + e.what());
  }
  if (!json.is_object() || json.value("schema", "") != schema)
    throw std::runtime_error(std::string("not a message of schema ") + schema);
  return json;
}

constexpr const char* request_schema = "tilth.request/1";
constexpr const char* answer_schema = "tilth.answer/1";

}  // namespace

std::string request_message(std::span<const RunIdentity> members) {
  Json list = Json::array();
  for (const RunIdentity& m : members) list.push_back(identity_json(m));
  return Json{{"schema", request_schema}, {"members", std::move(list)}}.dump();
}

std::vector<RunIdentity> read_request(const std::string& message) {
  std::vector<RunIdentity> members;
  try {
    const Json request = parsed(message, request_schema);
    for (const Json& m : request.at("members")) members.push_back(identity_from(m));
  } catch (const Json::exception& e) {
    throw std::runtime_error(std::string("a request lacks something: ") + e.what());
  }
  return members;
}

std::string answer_message(std::span<const RunRecord> records) {
  Json list = Json::array();
  for (const RunRecord& r : records) list.push_back(record_json(r));
  return Json{{"schema", answer_schema}, {"runs", std::move(list)}}.dump();
}

std::vector<RunRecord> read_answer(const std::string& message) {
  std::vector<RunRecord> records;
  try {
    const Json answer = parsed(message, answer_schema);
    for (const Json& r : answer.at("runs")) records.push_back(record_from(r));
  } catch (const Json::exception& e) {
    throw std::runtime_error(std::string("an answer lacks something: ") + e.what());
  }
  return records;
}

}  // namespace tilth
