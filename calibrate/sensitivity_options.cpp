// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <fmt/format.h>

#include "calibrate/emulator.hpp"
#include "calibrate/sensitivity.hpp"

namespace tilth {

std::string_view to_string(SensitivityMethod method) {
  switch (method) {
    case SensitivityMethod::morris:
      return "morris";
    case SensitivityMethod::sobol:
      return "sobol";
    case SensitivityMethod::emulator:
      return "sobol by emulator";
  }
  return "";
}

std::string_view to_string(SensitivityEnd end) {
  switch (end) {
    case SensitivityEnd::completed:
      return "completed";
    case SensitivityEnd::stopped:
      return "stopped";
    case SensitivityEnd::budget_spent:
      return "budget_spent";
  }
  return "";
}

std::string_view to_string(IndexKind kind) {
  switch (kind) {
    case IndexKind::mu:
      return "mu";
    case IndexKind::mu_star:
      return "mu_star";
    case IndexKind::sigma:
      return "sigma";
    case IndexKind::first_order:
      return "S";
    case IndexKind::total:
      return "ST";
    case IndexKind::second_order:
      return "Sij";
  }
  return "";
}

int default_num_rows(SensitivityMethod method, bool quick) {
  switch (method) {
    case SensitivityMethod::morris:
      return quick ? 6 : 16;
    case SensitivityMethod::sobol:
      return quick ? 16 : 64;
    case SensitivityMethod::emulator:
      return quick ? 24 : 64;
  }
  return 0;
}

int min_num_rows(SensitivityMethod method, std::size_t num_free) {
  if (method == SensitivityMethod::morris) return 4;
  if (method == SensitivityMethod::sobol) return 8;
  return static_cast<int>(
      min_emulator_points(EmulatorTrend::linear, static_cast<Eigen::Index>(num_free)));
}

std::vector<std::string> problems(const std::vector<Parameter>& parameters,
                                  const SensitivityOptions& o) {
  std::vector<std::string> found = problems(parameters);
  const std::size_t num_free = free_parameters(parameters).size();
  if (num_free == 0)
    found.emplace_back("no parameter is free (estimate 1 in parameters.csv): nothing to vary");
  const int least = min_num_rows(o.method, num_free);
  if (o.num_rows < least)
    found.push_back(fmt::format("samples = {}: must be {} or more for the method {}", o.num_rows,
                                least, to_string(o.method)));
  if (o.method == SensitivityMethod::emulator && o.num_rows > max_emulator_rows)
    found.push_back(
        fmt::format("samples = {}: an emulator takes {} at most", o.num_rows, max_emulator_rows));
  if (o.levels < 4 || o.levels % 2 != 0)
    found.push_back(fmt::format("levels = {}: must be even and 4 or more", o.levels));
  if (o.packings.num_packings < 1 || o.packings.num_packings > 1000)
    found.push_back(fmt::format("packings = {}: must be 1 to 1000", o.packings.num_packings));
  if (o.num_resamples < 100)
    found.push_back(fmt::format("resamples = {}: must be 100 or more", o.num_resamples));
  return found;
}

}  // namespace tilth
