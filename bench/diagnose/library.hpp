// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Stored simulations of one soil's laboratory, from which many diagnoses can be made without a new one.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/effect_choice.hpp"
#include "calibrate/cli/test_runs.hpp"
#include "calibrate/parameters.hpp"

namespace tilth::scoreboard {

/// What is simulated. Packings are those a fit or a diagnosis of seed 1 could use; twins use others.
struct LibraryPlan {
  Fidelity fidelity = Fidelity::preview;
  int num_points = 60;             ///< of the baseline's design, common packings
  int num_packings = 3;
  int num_nominal_packings = 16;   ///< at the nominal values: scatter, and the offset of the few
  int num_fingerprint_points = 12; ///< the first of the design
  int num_fingerprint_packings = 2;
  int num_costly_points = 10;      ///< for candidates that need another specimen, one packing
  double half_width = 0.35;        ///< of the design about the nominal values, in the unit cube
};

enum class RowKind { nominal, design, fingerprint };

/// One laboratory: all numbers of one member on one packing.
struct LibraryRow {
  RowKind kind = RowKind::design;
  int point = 0;              ///< of the design
  std::uint64_t packing = 0;
  int candidate = -1;         ///< position in candidate_choices(); -1: the baseline
  Eigen::VectorXd features;   ///< (p) physical, NaN where a test failed
};

struct Library {
  SoilData soil;                         ///< planned laboratory, effects among its parameters
  std::vector<Parameter> parameters;
  std::vector<CandidateChoice> choices;
  Eigen::MatrixXd points;                ///< (q, num_points) unit coordinates
  Eigen::VectorXd lower, upper;          ///< (q) edges of the design
  std::vector<LibraryRow> rows;
};

/// Reads `file` and simulates what it lacks, appending chunk by chunk: a run that was stopped goes on.
/// @throws ConfigError where the file was made for another plan or soil
Library stored_library(const std::filesystem::path& soil_folder, const LibraryPlan& plan,
                       const std::filesystem::path& file, const RunContext& context);

}  // namespace tilth::scoreboard
