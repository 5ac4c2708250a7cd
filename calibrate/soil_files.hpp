// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The parts of load_soil(), one per file of a soil folder, and the checks across files.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "calibrate/soil_data.hpp"

namespace tilth {

/// Fills id, name, site and state from soil.json ("tilth.soil/1").
void read_soil_json(const std::filesystem::path& file, SoilData& soil,
                    std::vector<std::string>& problems);

std::vector<TestCondition> read_conditions(const std::filesystem::path& file,
                                           const SoilVocabulary& vocabulary,
                                           std::vector<std::string>& problems);

/// Rows of measurements.csv. A row whose test, observable or value cannot be read is reported and
/// left out; other mistakes are reported and the row is kept, so that the cross-checks see it.
std::vector<SoilTarget> read_measurements(const std::filesystem::path& file,
                                          const SoilVocabulary& vocabulary,
                                          std::vector<std::string>& problems);

std::vector<SoilParameter> read_parameters(const std::filesystem::path& file,
                                           const SoilVocabulary& vocabulary,
                                           std::vector<std::string>& problems);

/// Rows of curves.csv by test and condition; nothing where there is no such file. A mistake that
/// goes through a whole curve (a wrong unit) is one sentence.
std::vector<MeasuredCurve> read_curves(const std::filesystem::path& file, const SoilData& soil,
                                       const SoilVocabulary& vocabulary,
                                       std::vector<std::string>& problems);

/// Rows of tracers.csv, where there is one, as targets of the sweep test: tracers of one plot, depth and
/// offset are a site; each site gets a condition "plot@<depth>m_<offset>m" and three targets, the mean
/// displacement forward, lateral and vertical with sigma = sqrt(sum sigma_i^2) / n.
void read_tracers(const std::filesystem::path& file, const SoilVocabulary& vocabulary, SoilData& soil,
                  std::vector<std::string>& problems);

/// What is wrong with the numbers of one parameter, whichever file they came from.
/// @param known  its physically possible range; may be null
std::vector<std::string> parameter_problems(const SoilParameter& parameter,
                                            const KnownParameter* known);

/// Ties that lead to an unknown parameter or in a circle: position of the parameter and a sentence.
std::vector<std::pair<std::size_t, std::string>> tie_problems(
    const std::vector<SoilParameter>& parameters);

/// Each target's condition exists and gives the stresses its observable needs; no row occurs twice.
void check_conditions_of_targets(const SoilData& soil, const SoilVocabulary& vocabulary,
                                 std::vector<std::string>& problems);

/// Moves every target with a better-founded row for the same number to `soil.superseded`.
void set_superseded_aside(SoilData& soil);

/// What is usable but must be said: too few observations, stale derived rows, nothing measured.
void add_warnings(SoilData& soil);

/// For each target the group it stands for, "" where the independent numbers are used up: a largest
/// matching of targets to their groups (augmenting paths). Hold-outs get "".
std::vector<std::string> independent_groups(const std::vector<SoilTarget>& targets);

}  // namespace tilth
