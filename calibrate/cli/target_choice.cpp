// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/target_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calibrate/config_error.hpp"

namespace tilth {
namespace {

bool is_of_sweep(const SoilTarget& t) { return t.test_id == "sweep_tillage"; }

}  // namespace

void choose_tests(const std::string& tests, SoilData& soil) {
  if (tests == "all") return;
  const bool sweep = tests == "sweep";
  std::erase_if(soil.targets, [sweep](const SoilTarget& t) { return is_of_sweep(t) != sweep; });
  if (std::ranges::all_of(soil.targets, &SoilTarget::holdout))
    throw ConfigError({fmt::format("--tests {}: {} has no such target to fit", tests, soil.id)});
}

std::size_t leave_out_sweep(SoilData& soil) {
  const bool has_others = std::ranges::any_of(
      soil.targets, [](const SoilTarget& t) { return !is_of_sweep(t) && !t.holdout; });
  return has_others ? std::erase_if(soil.targets, is_of_sweep) : 0;
}

}  // namespace tilth
