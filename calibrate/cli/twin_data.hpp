// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Measurements made by the model itself, with a truth that is known and told to nobody.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/effect_choice.hpp"

namespace tilth {

struct TwinNoise {
  double specimen_cv = 0.10;  ///< of every number of a specimen, beside what its packing does
  double rig_cv = 0.03;       ///< one factor per rig, the same for all its specimens: a seeker does not know of it
};

struct TwinPlan {
  std::vector<std::string> tests;  ///< of chosen_tests()
  std::vector<ChosenEffect> effects;
  TwinNoise noise;
  int num_replicates = 5;
  Fidelity fidelity = Fidelity::search;
  std::uint64_t seed = 1;
};

struct TwinData {
  SoilData soil;            ///< conditions and one target per specimen and number
  Eigen::VectorXd values;   ///< the truth, in the order of soil.parameters (effects included)
  std::vector<std::string> lost;  ///< specimens whose test failed, with the reason; their rows are missing
};

/// Parameters of the truth: every estimated one drawn evenly in its coordinate within a fifth of its range about the
/// nominal value, and within the middle nine tenths of the range; the effects as chosen.
Eigen::VectorXd twin_truth(const SoilData& soil, const TwinPlan& plan);

/// Packing of a replicate: seeds from 600 000 000 on, which no fit or diagnosis uses.
std::uint64_t twin_packing(std::uint64_t seed, int replicate);

/// Spoils the numbers of specimens: value x exp(rig N(0,1) rig_cv + N(0,1) specimen_cv); of what may be negative (displacements)
/// value x rig + N(0,1) specimen_cv x root mean square of the number.
///
/// sigma of a row is the standard deviation of its replicates (of their logarithms where they are positive), as a laboratory would state it.
/// @pre the soil has the targets and effect parameters the specimens were made with
/// @param runs  one per replicate, a partial simulator's
/// @throws ConfigError if fewer than two specimens of a number could be made
TwinData twin_of(SoilData soil, const TwinPlan& plan, const Eigen::VectorXd& values,
                 const std::vector<Evaluation>& runs);

/// Simulates the laboratory at the truth, one packing per replicate, and spoils the numbers. @throws ConfigError as twin_of()
TwinData make_twin(SoilData soil, const TwinPlan& plan, const RunContext& context);

}  // namespace tilth
