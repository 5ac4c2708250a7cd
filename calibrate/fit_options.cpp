// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/fit_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tilth {

FitOptions quick_fit_options() {
  FitOptions options;
  options.num_design = 12;
  options.num_noise_seeds = 3;
  options.num_search_seeds = 1;
  options.num_confirm_seeds = 2;
  options.num_fresh_seeds = 2;
  options.num_rounds = 1;
  options.round_size = 4;
  options.num_starts = 1;
  options.max_iterations = 5;
  options.max_bias_rounds = 1;
  options.chi_square_tolerance = 0.1;
  return options;
}

FitOptions smooth_fit_options() {
  FitOptions options;
  options.num_design = 0;
  options.num_noise_seeds = 0;
  options.num_search_seeds = 1;
  options.num_fresh_seeds = 0;
  options.num_rounds = 0;
  options.num_starts = 1;
  options.max_iterations = 2000;
  options.max_bias_rounds = 0;
  options.chi_square_tolerance = 0.0;
  options.function_tolerance = 1e-15;
  options.parameter_tolerance = 1e-15;
  options.gradient_tolerance = 0.0;
  options.derivatives = DerivativeRule::extrapolated;
  options.profiles = ProfileSource::simulator;
  options.max_simulations = 1'000'000;
  return options;
}

std::vector<std::string> problems(const FitOptions& options) {
  std::vector<std::string> found;
  const auto at_least = [&](const char* name, int value, int least) {
    if (value < least)
      found.push_back(fmt::format("{} = {}: must be {} or more", name, value, least));
  };
  const auto positive = [&](const char* name, double value) {
    if (!(std::isfinite(value) && value > 0.0)) {
      found.push_back(fmt::format("{} = {}: must be finite and positive", name, value));
    }
  };
  const auto not_negative = [&](const char* name, double value) {
    if (!(std::isfinite(value) && value >= 0.0)) {
      found.push_back(fmt::format("{} = {}: must be finite and not negative", name, value));
    }
  };
  at_least("num_design", options.num_design, 0);
  at_least("num_noise_seeds", options.num_noise_seeds, 0);
  at_least("num_search_seeds", options.num_search_seeds, 1);
  at_least("num_confirm_seeds", options.num_confirm_seeds, 1);
  at_least("num_fresh_seeds", options.num_fresh_seeds, 0);
  at_least("num_rounds", options.num_rounds, 0);
  at_least("round_size", options.round_size, 1);
  at_least("num_starts", options.num_starts, 1);
  at_least("max_iterations", options.max_iterations, 1);
  at_least("max_bias_rounds", options.max_bias_rounds, 0);
  not_negative("chi_square_tolerance", options.chi_square_tolerance);
  not_negative("function_tolerance", options.function_tolerance);
  not_negative("parameter_tolerance", options.parameter_tolerance);
  not_negative("secant_tolerance", options.secant_tolerance);
  not_negative("gradient_tolerance", options.gradient_tolerance);
  positive("log_step", options.log_step);
  positive("linear_step", options.linear_step);
  positive("holdout_limit", options.holdout_limit);
  // Seeds of the stages are 1000 apart.
  const int most = std::max({options.num_noise_seeds, options.num_search_seeds,
                             options.num_confirm_seeds, options.num_fresh_seeds});
  if (most > 1000) found.push_back(fmt::format("{} seeds in one stage: at most 1000", most));
  if (options.max_simulations == 0) found.emplace_back("max_simulations = 0: must be 1 or more");
  return found;
}

std::vector<PlannedStage> planned_stages(const FitOptions& options, std::size_t num_free,
                                         bool has_confirm, bool has_holdout) {
  const auto count = [](int value) { return static_cast<std::size_t>(std::max(0, value)); };
  const auto iterations = static_cast<std::size_t>(std::min(6, options.max_iterations));
  const std::size_t iteration = count(options.num_search_seeds) * (2 * num_free + 2);
  std::vector<PlannedStage> stages = {
      {"design", "search", 1 + count(options.num_design)},
      {"noise floor", "search", count(options.num_noise_seeds)},
      {"search", "search", count(options.num_rounds) * count(options.round_size)},
      {"local search", "search", count(options.num_starts) * iterations * iteration}};
  if (has_confirm) {
    const std::size_t rounds = count(options.max_bias_rounds);
    stages.push_back({"bias", "confirm", rounds * count(options.num_confirm_seeds)});
    stages.push_back({"bias", "search", 2 * rounds * iteration});
  }
  stages.push_back({"fresh seeds", has_confirm ? "confirm" : "search", count(options.num_fresh_seeds)});
  if (has_holdout)
    stages.push_back({"fresh seeds", "hold-outs", count(options.num_fresh_seeds) + 2 * num_free});
  return stages;
}

std::size_t expected_simulations(const FitOptions& options, std::size_t num_free,
                                 bool has_confirm) {
  std::size_t total = 0;
  for (const PlannedStage& s : planned_stages(options, num_free, has_confirm, false))
    total += s.num_simulations;
  return std::min(total, options.max_simulations);
}

}  // namespace tilth
