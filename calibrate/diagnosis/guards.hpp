// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What may not be named although the statistics of one campaign would allow it.
#pragma once

#include <string>
#include <vector>

#include "calibrate/diagnosis/verdict.hpp"

namespace tilth {

struct GuardFacts {
  bool has_replicates = true;              ///< scatter of specimens was measured
  std::vector<std::string> failed_gates;   ///< ids of numerical effects that move the statistics
};

/// - Noise that no data support: a name becomes `suggested`.
/// - Rate-dependent strength cannot be told from a simulation that loads too fast while changing its speed moves the
///   statistics: the name becomes the set of both.
/// The reason is added to `diagnosis.reason`.
void apply_guards(const GuardFacts& facts, Diagnosis& diagnosis);

}  // namespace tilth
