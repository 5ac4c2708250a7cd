// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Fitted soils beside each other: which parameters differ, and how far a sweep throws each soil.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/test_runs.hpp"

namespace tilth {

struct FittedSoil {
  SoilData soil;
  FittedSet set;
  int exit_code = 0;                   ///< of its fit
  SweepTillageConfig sweep;            ///< the one test all soils are compared in
  std::vector<ExperimentResult> runs;  ///< of that sweep at the fitted values, those that completed
  std::vector<std::string> failures;
};

/// Draws the standard sweep of `fidelity` through every soil at its fitted values.
void run_sweeps(std::vector<FittedSoil>& soils, Fidelity fidelity, int num_packings, std::uint64_t first_seed,
                const RunContext& context);

struct MeanAndSd {
  double mean = 0.0, sd = 0.0;  ///< sd NaN for fewer than two
};

MeanAndSd over_packings(const std::vector<ExperimentResult>& runs, const std::string& feature);

/// Features of the sweep that are set beside each other: draught, contacts, areas, displacement by depth.
std::vector<std::string> compared_features(const FittedSoil& soil);

/// The values a fit estimated.
std::vector<const FittedSet::Value*> estimated(const FittedSet& set);

/// How one parameter of two soils compares.
struct PairRow {
  std::string a, b, parameter, word;  ///< soil ids; difference_word()
};

std::vector<PairRow> pairs_of(const std::vector<FittedSoil>& soils);

/// "differ", "not distinguishable", or "not known" where a soil has no interval for the parameter.
std::string difference_word(const FittedSet::Value& a, const FittedSet::Value& b);

/// comparison.txt: parameters with intervals and verdicts, pairs that differ, displacement and draught beside the
/// D497 band. Every number of it is simulated or fitted.
std::string comparison_text(const std::vector<FittedSoil>& soils, const std::string& head);

/// comparison.json, schema "tilth.comparison/1".
std::string comparison_json(const std::vector<FittedSoil>& soils, const std::string& command);

/// Parameters relative to the mean of the soils, and displacement by depth. @return empty, or why there is none
std::string draw_comparison(const std::vector<FittedSoil>& soils, const std::string& title,
                            const std::filesystem::path& svg);

}  // namespace tilth
