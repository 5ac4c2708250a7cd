// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The scoreboard itself: what was hidden against what was said.
#pragma once

#include <string>
#include <vector>

#include "bench/diagnose/cases.hpp"

namespace tilth::scoreboard {

/// One scored case.
struct Score {
  HiddenCase hidden;
  bool is_lost = false;                ///< no specimens: counted apart
  std::string verdict;
  std::vector<std::string> names;      ///< of named and suggested
  std::vector<std::string> set;
  bool set_holds_none = false, set_holds_other = false;
  bool can_see = false;                ///< power: (size / standard error)^2 of the truth at least 16.1 (90 %)
  bool is_separable = false;           ///< lambda (1 - |rho|) >= 5.41 against every other measurable candidate
  std::string nearest;                 ///< candidate of the largest |rho|
  double lambda = 0.0, rho = 0.0;
  double size_ratio = 0.0;             ///< said over hidden; NaN without a right name
  bool size_inside = false;            ///< 90 % interval holds the hidden size
  double posterior = 0.0;              ///< inclusion of the leading effect
  /// Proven gaps by real simulations: baseline, said, truth (the hidden effect refitted). NaN: not made.
  double before = 0.0, said = 0.0, oracle = 0.0;
  double before_held_out = 0.0, said_held_out = 0.0, oracle_held_out = 0.0;
};

/// One line of CSV per case, and its heading.
std::string csv_heading();
std::string csv_line(const Score& s);

/// Tables in Markdown: matrix by kind, metrics with 95 % intervals (Clopper & Pearson 1934), by effect, mistakes one by one.
std::string tables(const std::vector<Score>& scores);

}  // namespace tilth::scoreboard
