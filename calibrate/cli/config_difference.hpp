// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Are two runs the same run?
#pragma once

#include <string>
#include <vector>

namespace tilth {

/// "/fit/seed: 1 there, 2 here" for every value in which two config.json differ, but for the tool
/// that wrote them and for budgets, which may be raised between starts.
std::vector<std::string> config_differences(const std::string& there, const std::string& here);

}  // namespace tilth
