// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

namespace tilth {

const char* name_of(RunStatus status) {
  switch (status) {
    case RunStatus::completed: return "completed";
    case RunStatus::diverged: return "diverged";
    case RunStatus::not_settled: return "not_settled";
    case RunStatus::stopped: return "stopped";
    case RunStatus::lost: return "lost";
  }
  return "unknown";
}

double ExperimentResult::feature(const std::string& feature_name) const {
  for (const Feature& f : features)
    if (f.name == feature_name) return f.value;
  return std::numeric_limits<double>::quiet_NaN();
}

std::string curve_csv(const Curve& curve) {
  std::string text = fmt::format("{}\n", fmt::join(curve.columns, ","));
  for (const auto& row : curve.rows) text += fmt::format("{:.9g}\n", fmt::join(row, ","));
  return text;
}

}  // namespace tilth
