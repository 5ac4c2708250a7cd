// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// From the evidence of the soils to a verdict, and to the models that are worth a refit.
#pragma once

#include <vector>

#include "calibrate/cli/diagnosis_case.hpp"
#include "calibrate/diagnosis/verdict.hpp"

namespace tilth {

/// The decision with its guards; where a soil has no evidence, `inconclusive` and why.
Diagnosis decided(const std::vector<SoilCase>& soils, const DiagnosisOptions& options);

/// Effects that are refitted and compared, positions in the catalogue: what is named together as one model, then the most
/// probable others, three models at most.
std::vector<std::vector<std::size_t>> contenders_of(const Diagnosis& diagnosis);

}  // namespace tilth
