// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What is hidden: cases drawn by seed, and their data folders. The hider's half of the scoreboard.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/diagnose/library.hpp"
#include "calibrate/cli/effect_choice.hpp"

namespace tilth::scoreboard {

enum class CaseKind { single, nothing, trap, outside, pair };
const char* name_of(CaseKind kind);

struct HiddenCase {
  std::string id;                     ///< "0017"; says nothing
  CaseKind kind = CaseKind::nothing;
  std::uint64_t seed = 0;             ///< of truth, specimens and noise
  std::vector<ChosenEffect> effects;  ///< switched on
  /// outside: fixed parameters of the model that no candidate changes, with their values.
  std::vector<std::pair<std::string, double>> model_changes;
  std::string struck_candidate;       ///< outside: taken off the seeker's catalogue; "" = none
};

/// How many of each kind a batch has.
struct BatchPlan {
  std::string name;  ///< "development", "sealed-1"; its seeds follow from it
  std::uint64_t seed = 0;
  int num_singles = 0, num_nothing = 0, num_traps = 0, num_outside = 0, num_pairs = 0;
};
/// @throws ConfigError for a name that is no batch
BatchPlan batch_plan(const std::string& name);

/// The cases in mixed order.
///
/// single   one soil effect that the laboratory touches, size log-uniform in half to twice the typical one
/// trap     one artefact of measurement, the same sizes, either sign where it may have one; or of numerics, half to once the typical size
/// outside  one soil effect of one to two typical sizes whose candidate is struck off, or a fixed ratio of the model changed
/// pair     two soil effects, one to two typical sizes
/// Candidates that moved no number of the library are not drawn.
std::vector<HiddenCase> draw_cases(const BatchPlan& plan, const Library& library);

/// Simulates specimens and writes a data folder FOLDER/<id> for every case that has none yet: five specimens, 10 % noise per
/// number, 3 % per rig. A case whose specimens fail leaves a file FOLDER/<id>.lost with the reason.
void make_cases(const std::vector<HiddenCase>& cases, const std::filesystem::path& soil_folder, Fidelity fidelity,
                const std::filesystem::path& folder, const RunContext& context);

}  // namespace tilth::scoreboard
