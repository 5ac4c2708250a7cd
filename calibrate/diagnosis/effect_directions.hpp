// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The a-priori table of what every effect does to every kind of measurement.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/diagnosis/effect_scores.hpp"

namespace tilth {

/// One row: an effect of the catalogue, or a parameter of the baseline of the toy.
struct DirectionRow {
  std::string id;
  std::string short_name;  ///< "ROLL"; "" for parameters
  bool is_parameter = false;
  EffectSign sign = EffectSign::positive;
  /// Level of the log change at typical size: 0 below 3 %, 1 below 10 %, 2 10 to 30 %, 3 above 30
  /// %, with its sign.
  Eigen::VectorXi levels;
  std::string provenance, source;
};

struct DirectionTable {
  std::vector<std::string> measures;  ///< names of the levels, in order
  std::vector<DirectionRow> rows;
  Eigen::Index measure(const std::string& name) const;  ///< -1 if there is none
};

/// Reads data/effect_directions.csv. Expert judgement, to be replaced by measured fingerprints: it
/// serves the linear toy, and tests that ask for an explanation where a measured sign contradicts
/// it.
/// @throws ConfigError with all mistakes: unknown or missing columns, levels that are no integers
/// in
///         [-3, 3], repeated ids
DirectionTable read_effect_directions(const std::filesystem::path& file);

}  // namespace tilth
