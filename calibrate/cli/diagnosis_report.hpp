// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a diagnosis says: sentences, JSON and figures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/cli/diagnosis_run.hpp"

namespace tilth {

struct DiagnosisContext {
  DiagnosisSettings settings;
  std::string command;
  std::string provenance_sentence = {};
  bool preview = false;
  std::vector<std::filesystem::path> inputs = {};
  std::size_t num_simulations = 0, num_failed = 0;
};

/// Everything a diagnosis found.
struct DiagnosisResult {
  Diagnosis diagnosis;
  std::vector<SoilCase> soils;
  std::vector<ExperimentAdvice> advice;
  std::vector<std::string> contenders;  ///< ids that were refitted, the name or most probable first
};

/// Sum over the statistics of all soils: root mean square gap of a model on fitted or held-out data; nothing without such data.
std::optional<double> overall_gap(const std::vector<SoilCase>& soils, std::size_t model, bool holdout);

/// The first sentence: what is missing, how sure, what it closed.
std::string verdict_sentence(const DiagnosisResult& result);

/// diagnosis.txt
std::string diagnosis_text(const DiagnosisResult& result, const DiagnosisContext& context);

/// diagnosis.json, schema "tilth.diagnosis/1".
std::string diagnosis_json(const DiagnosisResult& result, const DiagnosisContext& context);

/// config.json, for --resume.
std::string diagnosis_config_json(const std::vector<SoilCase>& soils, const DiagnosisSettings& settings, bool preview);

/// Figures of one folder: residuals, probabilities, gap before and after, look-alikes. @return why one is missing
std::vector<std::string> draw_diagnosis(const DiagnosisResult& result, const std::filesystem::path& folder);

}  // namespace tilth
