// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The measurements of one soil as the diagnosis needs them: statistics, specimens, their scatter.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibrate/soil_data.hpp"

namespace tilth {

/// Specimens of one test under one condition. Statistics of one specimen are correlated.
struct MeasuredTest {
  std::string experiment;               ///< the rig: "direct_shear"
  std::string condition_id;
  std::vector<Eigen::Index> statistics; ///< (m) positions in MeasuredCampaign::means.targets
  Eigen::MatrixXd replicates;           ///< (n, m) T; one row where nothing was repeated
};

/// Replicates gathered: one target per test, observable and condition.
///
/// T is the logarithm of what is positive by nature (docs/data.md), else the value itself.
struct MeasuredCampaign {
  SoilData means;                ///< the soil; value and sigma are those of the mean over specimens
  std::vector<MeasuredTest> tests;
  /// (p) what T is divided by to be a relative change: 1 for logarithms, else the size of the value.
  Eigen::VectorXd scale;
  /// (p) variance of one specimen to believe before its own replicates: pooled over the conditions of an
  /// observable where these have four degrees of freedom or more, else the stated sigma squared.
  Eigen::VectorXd prior_variances;
  bool has_replicates = false;   ///< at least one test was repeated, with scatter
  std::vector<std::string> remarks;  ///< what the report must say about the data, one sentence each
};

/// Gathers the rows of a soil. Rows without replicateId count as one specimen. Specimens that lack one of
/// their test's numbers are left out of that test (a remark says so).
///
/// Replicates that do not scatter at all have no sample variance: the stated sigma stands in, with a remark.
/// @throws ConfigError for points of curves (xId), and values that are not positive where they must be
MeasuredCampaign measured_campaign(const SoilData& soil);

}  // namespace tilth
