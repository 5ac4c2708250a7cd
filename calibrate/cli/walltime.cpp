// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/walltime.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace tilth {
namespace {

/// Whole numbers between colons; empty if one is none.
std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(':', at), text.size());
    const std::string word = text.substr(at, end - at);
    const bool digits = !word.empty() && word.size() < 10 &&
                        std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!digits) return {};
    numbers.push_back(std::stod(word));
    at = end + 1;
  }
  return numbers;
}

}  // namespace

std::optional<double> seconds_of_walltime(const std::string& text) {
  const std::size_t dash = text.find('-');
  const bool has_days = dash != std::string::npos;
  const std::vector<double> days = has_days ? numbers_in(text.substr(0, dash)) : std::vector{0.0};
  const std::vector<double> rest = numbers_in(has_days ? text.substr(dash + 1) : text);
  if (days.size() != 1 || rest.empty() || rest.size() > 3) return std::nullopt;
  double seconds = 86400 * days[0];
  // with days the first number is hours; without, one number is minutes and two are minutes:seconds
  double unit = has_days || rest.size() == 3 ? 3600 : 60;
  for (const double number : rest) {
    seconds += unit * number;
    unit /= 60;
  }
  return seconds > 0 ? std::optional(seconds) : std::nullopt;
}

}  // namespace tilth
