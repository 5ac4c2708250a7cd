// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The laboratory of twins, of advice and of sensitivity studies: which numbers of which tests under which conditions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibrate/soil_data.hpp"

namespace tilth {

/// Tests of the laboratory, without the soil bin.
std::vector<std::string> laboratory_tests();

/// The tests a list of words stands for: test ids, "laboratory" (element tests without steel), "bed" (cone, vane,
/// heap), "sweep" (the soil bin), "all".
/// @throws ConfigError naming the known words
std::vector<std::string> chosen_tests(const std::vector<std::string>& words);

/// Conditions and targets of the chosen tests, put in the place of the soil's own. Values are 0 and sigmas 1: they
/// are to be filled in. One condition per rig is held out: an interpolation point, for proofs.
void set_laboratory(SoilData& soil, std::span<const std::string> tests);

/// conditions.csv with the columns that are used.
std::string conditions_csv(const std::vector<TestCondition>& conditions);

}  // namespace tilth
