// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/run_config.hpp"

#include "calibrate/config_error.hpp"
#include "calibrate/fit_config.hpp"

namespace tilth {
namespace {

void read_fit_object(JsonObjectReader& fit, FitOptions& o) {
  const auto count = [&fit](const char* key, int& value, int least) {
    value = static_cast<int>(fit.integer(key, value, least, 1'000'000));
  };
  count("num_design", o.num_design, 0);
  count("num_noise_seeds", o.num_noise_seeds, 0);
  count("num_search_seeds", o.num_search_seeds, 1);
  count("num_confirm_seeds", o.num_confirm_seeds, 1);
  count("num_fresh_seeds", o.num_fresh_seeds, 0);
  count("num_rounds", o.num_rounds, 0);
  count("round_size", o.round_size, 1);
  count("num_starts", o.num_starts, 1);
  count("max_iterations", o.max_iterations, 1);
  count("max_bias_rounds", o.max_bias_rounds, 0);
  const JsonRange positive{.lower = 0.0, .open_lower = true};
  o.chi_square_tolerance = fit.number("chi_square_tolerance", o.chi_square_tolerance, positive);
  o.secant_tolerance = fit.number("secant_tolerance", o.secant_tolerance, positive);
  o.log_step = fit.number("log_step", o.log_step, positive);
  o.linear_step = fit.number("linear_step", o.linear_step, positive);
  o.holdout_limit = fit.number("holdout_limit", o.holdout_limit, positive);
  o.rescale_sigma = fit.flag("rescale_sigma", o.rescale_sigma);
  o.max_simulations = static_cast<std::size_t>(
      fit.unsigned_integer("max_simulations", static_cast<std::uint64_t>(o.max_simulations)));
}

}  // namespace

void read_fit_options(JsonObjectReader& config, FitOptions& options) {
  if (auto fit = config.object("fit")) {
    read_fit_object(*fit, options);
    fit->finish();
  }
}

void apply_run_config(const std::filesystem::path& file, SoilData& soil, FitOptions& options) {
  std::vector<std::string> problems;
  const JsonDocument document = read_json(file, problems);
  if (!problems.empty()) throw ConfigError(problems);
  JsonObjectReader object(document, problems);
  object.schema("tilth.fit/1");
  const FitConfig config = read_fit_config(object);
  read_fit_options(object, options);
  object.finish();
  if (!problems.empty()) throw ConfigError(problems);
  apply_fit_config(config, file.string(), soil, problems);
  if (!problems.empty()) throw ConfigError(problems);
}

Eigen::VectorXd nominal_values(const SoilData& soil) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(soil.parameters.size()));
  for (std::size_t k = 0; k < soil.parameters.size(); ++k)
    values[static_cast<Eigen::Index>(k)] = soil.parameters[k].nominal;
  return values;
}

}  // namespace tilth
