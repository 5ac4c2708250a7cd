// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What one soil brings to the diagnosis: samples, their noise, and the simulator near the optimum.
#pragma once

#include <string>
#include <vector>

#include "calibrate/diagnosis/effect_scores.hpp"
#include "calibrate/diagnosis/noise.hpp"
#include "calibrate/diagnosis/projection.hpp"

namespace tilth {

/// Everything is in the same p statistics. The packings of `samples` are simulated at theta with
/// seeds that neither the fit nor the fingerprints used.
struct SoilEvidence {
  std::string soil;
  LinearModel model;
  std::vector<TestSamples> samples;
  NoisePriors noise;
  std::vector<CandidateEffect> candidates;  ///< (K); typical sizes may depend on the soil
};

/// Residual r (mean of specimens minus mean of packings), V, and their projection.
struct AnalysedSoil {
  Eigen::VectorXd residual;
  NoiseCovariance noise;
  ProjectedEvidence projected;
};

/// @throws std::invalid_argument as noise_covariance() and project()
AnalysedSoil analysed(const SoilEvidence& soil);

/// The same with other samples (a resample, a repetition).
AnalysedSoil analysed(const SoilEvidence& soil, const std::vector<TestSamples>& samples);

}  // namespace tilth
