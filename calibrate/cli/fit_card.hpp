// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// fit.json, the parameter card: written after a fit, read by simulate and export.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/fit_options.hpp"
#include "calibrate/fit_summary.hpp"

namespace tilth {

/// What the card says beside the summary. Nothing here depends on the machine or on how often the
/// run was interrupted: the card of a command and seed is always the same, byte for byte.
struct FitCardContext {
  std::uint64_t seed = 1;
  bool quick = false;
  std::string provenance_sentence;
  double measured_share = 0.0;
  Fidelity search = Fidelity::search;
  Fidelity confirm = Fidelity::confirm;
  std::string command;
  std::vector<std::filesystem::path> inputs;
  std::string criterion;  ///< the hold-out pass mark, as written before the fit
};

/// The card as JSON text, schema "tilth.card/1".
std::string fit_card_json(const SoilData& soil, const FitSummary& summary,
                          const FitCardContext& context);

/// config.json: every default written out.
std::string run_config_json(const SoilData& soil, const FitOptions& options,
                            const FitCardContext& context);

/// What other commands need of a card.
struct FittedSet {
  std::string soil_id;
  SoilMaterial material;
  double particle_radius_m = 0.0;  ///< mean, of the confirming specimens
  struct Value {
    std::string name;
    double value = 0.0, lo95 = 0.0, hi95 = 0.0;
    std::string role, verdict;
  };
  std::vector<Value> parameters;
  std::string provenance_sentence;
  std::string status;
  std::uint64_t seed = 0;
  bool preview = false;  ///< of a --quick fit
  std::vector<std::string> warnings;
  std::string valid_for, not_calibrated_for;
};

/// Accepts fit.json or the run folder that holds it. @throws ConfigError with every problem
FittedSet read_fit_card(const std::filesystem::path& card_or_folder);

/// Result of `simulate`: status, features, config and material of every member.
std::string simulation_json(const TestConfig& config, const SoilMaterial& material,
                            const std::vector<std::uint64_t>& seeds,
                            const std::vector<ExperimentResult>& results,
                            const std::string& command);

}  // namespace tilth
