// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// A sensitivity study as text and as tables.
#pragma once

#include <string>
#include <vector>

#include "calibrate/sensitivity.hpp"

namespace tilth {

/// What the reports say that the study does not know.
struct SensitivityContext {
  std::string subject;     ///< "loamy_sand"
  std::string provenance;  ///< share of measured targets, one sentence
  bool preview = false;    ///< labelled PREVIEW in every output
};

/// "PREVIEW (--quick): ..." or nothing.
std::string preview_sentence(const SensitivityContext& context);
/// "Morris, 4 levels ..., 16 trajectories of 4 points", "Sobol, 64 rows of 8 points", ...
std::string method_sentence(const SensitivitySummary& summary);
/// Share of failed runs in total, in words: printed whatever it is.
std::string failure_sentence(const SensitivitySummary& summary);
/// Share of a feature's variance that is packing noise, with its interval, in words.
std::string noise_sentence(const FeatureSensitivity& feature);
/// What a user should do next: an emulator or more samples where intervals are wide; or nothing.
std::string advice(const SensitivitySummary& summary);

/// The human report. No index without its interval and scale, none left out without the reason.
std::string sensitivity_report_text(const SensitivitySummary& summary,
                                    const SensitivityContext& context);

/// One line per feature and index: feature, scale, method, levels, num_rows, index, parameter,
/// other_parameter, value, low95, high95, bound_low, bound_high, num_values, noise_share,
/// noise_floor, failed_share, failures, emulator_q2, preview. Empty: not known.
std::string sensitivity_csv(const SensitivitySummary& summary, const SensitivityContext& context);

/// One line per run: row, point, is_repeat, packing_seed, status, parameters, features (physical,
/// SI), message, preview. Status partial: some of its tests failed.
std::string samples_csv(const SensitivitySummary& summary, const std::vector<Parameter>& parameters,
                        const SensitivityContext& context);

}  // namespace tilth
