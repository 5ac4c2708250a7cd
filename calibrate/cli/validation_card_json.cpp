// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <fstream>

#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/cli/validation_card.hpp"
#include "calibrate/config_error.hpp"

namespace tilth {
namespace {

using Json = nlohmann::ordered_json;

Parameter parameter_from(const Json& p) {
  Parameter result;
  result.name = p.at("name");
  result.start = p.at("value");
  result.estimate = p.contains("bounds");
  result.log_scale = p.value("standard_error_of", "") == "ln(value)";
  if (result.estimate) {
    result.lower = p.at("bounds").at(0);
    result.upper = p.at("bounds").at(1);
  }
  return result;
}

Eigen::MatrixXd matrix_from(const Json& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd m(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Json& value = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j));
      if (!value.is_number()) return {};
      m(i, j) = value;
    }
  return m;
}

}  // namespace

FittedUncertainty read_fitted_uncertainty(const std::filesystem::path& card_or_folder) {
  const std::filesystem::path file = std::filesystem::is_directory(card_or_folder)
                                         ? card_or_folder / "fit.json"
                                         : card_or_folder;
  std::ifstream in(file);
  const Json card = in ? Json::parse(in, nullptr, false) : Json();
  if (!card.is_object() || card.value("schema", "") != "tilth.card/1")
    throw ConfigError({fmt::format("{}: is missing or no parameter card", file.string())});
  try {
    FittedUncertainty fit;
    fit.soil_id = card.at("name");
    fit.seed = card.at("seed");
    fit.preview = card.at("engine").value("preview", false);
    for (const Json& p : card.at("parameters")) fit.parameters.push_back(parameter_from(p));
    fit.covariance = matrix_from(card.at("covariance"));
    fit.criterion = card.at("validation").value("criterion", "");
    fit.limit = card.at("validation").at("limit").is_number() ? card["validation"]["limit"].get<double>() : 2.0;
    return fit;
  } catch (const Json::exception& e) {
    throw ConfigError({fmt::format("{}: is no whole parameter card: {}", file.string(), e.what())});
  }
}

std::string validation_config_json(const FittedUncertainty& fit, const std::string& data_id,
                                   const std::vector<std::uint64_t>& seeds) {
  Json config = {{"schema", "tilth.validation_run/1"}, {"tool", solver_version}, {"fit", Json::object()},
                 {"data", data_id},                    {"packings", seeds},      {"criterion", fit.criterion}};
  config["fit"]["soil"] = fit.soil_id;
  for (const Parameter& p : fit.parameters) config["fit"][p.name] = p.start;
  return config.dump(2) + "\n";
}

std::string validation_json(const Validation& v, const FittedUncertainty& fit, const std::string& data_id) {
  Json targets = Json::array();
  for (const TargetResult& t : v.targets)
    targets.push_back({{"name", t.name},
                       {"target", json_number(t.value)},
                       {"sigma", json_number(t.sigma)},
                       {"sigma_of", t.log_transform ? "ln(value)" : "value"},
                       {"sim", json_number(t.simulated)},
                       {"sim_sd", json_number(t.seed_sd)},
                       {"parameter_sd", json_number(t.parameter_sd)},
                       {"sigma_total", json_number(t.sigma_total)},
                       {"residual", json_number(t.residual)},
                       {"provenance", std::string(to_string(t.provenance))}});
  Json failures = Json::array();
  for (const FailedRun& f : v.failures) failures.push_back({{"seed", f.seed}, {"message", f.message}});
  const Json out = {{"schema", "tilth.validation/1"},
                    {"solver", solver_version},
                    {"fit_of", fit.soil_id},
                    {"data", data_id},
                    {"preview", fit.preview},
                    {"criterion", fit.criterion},
                    {"rms_residual", json_number(v.rms)},
                    {"limit", json_number(v.limit)},
                    {"passed", v.targets.empty() ? Json(nullptr) : Json(v.passed())},
                    {"n_seeds", v.num_seeds},
                    {"parameter_errors", v.has_parameter_errors},
                    {"targets", targets},
                    {"failures", failures}};
  return out.dump(2) + "\n";
}

}  // namespace tilth
