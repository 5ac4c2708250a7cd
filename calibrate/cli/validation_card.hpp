// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a validation reads of a fit, and what it writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/validation.hpp"

namespace tilth {

/// Values and uncertainty of a fit.json.
struct FittedUncertainty {
  std::string soil_id;
  std::uint64_t seed = 0;
  bool preview = false;
  std::vector<Parameter> parameters;  ///< all; `start` is the fitted value
  Eigen::MatrixXd covariance;         ///< of the free ones, in the coordinate; empty if the fit has none
  std::string criterion;              ///< as written before the fit
  double limit = 2.0;
};

/// @throws ConfigError if the file is missing, no parameter card, or of a fit that gave no values
FittedUncertainty read_fitted_uncertainty(const std::filesystem::path& card_or_folder);

std::string validation_config_json(const FittedUncertainty& fit, const std::string& data_id,
                                   const std::vector<std::uint64_t>& seeds);
std::string validation_json(const Validation& validation, const FittedUncertainty& fit,
                            const std::string& data_id);

}  // namespace tilth
