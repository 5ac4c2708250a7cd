// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The model with the named effect, as a fit.json that every other command reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/cli/diagnosis_report.hpp"

namespace tilth {

/// Fits baseline and named effects together by the ordinary pipeline, starting at the refit, and writes fit.json and
/// fit_report.txt: into the folder for one soil, into <folder>/<soil> for several.
/// @return what to tell the user, one sentence per file, or why there is none
std::vector<std::string> write_extended_fits(const DiagnosisResult& result, const DiagnosisContext& diagnosis,
                                             const RunContext& context, const std::filesystem::path& folder);

}  // namespace tilth
