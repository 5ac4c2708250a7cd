// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/soil_evidence.hpp"

namespace tilth {

AnalysedSoil analysed(const SoilEvidence& soil) { return analysed(soil, soil.samples); }

AnalysedSoil analysed(const SoilEvidence& soil, const std::vector<TestSamples>& samples) {
  AnalysedSoil result;
  result.noise = noise_covariance(samples, soil.noise);
  result.residual =
      mean_difference(samples, static_cast<Eigen::Index>(soil.model.statistics.size()));
  result.projected = project(soil.model, result.residual, result.noise.total());
  return result;
}

}  // namespace tilth
