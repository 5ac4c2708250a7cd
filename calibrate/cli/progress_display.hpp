// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What is being done and how long it will take: a live bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "calibrate/evaluator.hpp"

namespace tilth {

class ProgressDisplay {
 public:
  /// @param terminal  true: one line rewritten in place on standard error
  /// @param log       gets the plain lines (one per stage, and one every ten seconds)
  ProgressDisplay(bool terminal, std::function<void(const std::string&)> log);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const Progress& progress);
  void finish();  ///< ends the live line

 private:
  double seconds() const;
  bool terminal_;
  bool line_open_ = false;
  std::function<void(const std::string&)> log_;
  std::chrono::steady_clock::time_point start_;
  double last_line_s_ = -1e9;
  std::string last_stage_;
};

/// "1:05" or "1:02:03".
std::string clock_text(double seconds);

/// One line: stage, simulations done of expected, elapsed, time left (elapsed / done x rest).
std::string progress_line(const Progress& progress, double elapsed_s);

}  // namespace tilth
