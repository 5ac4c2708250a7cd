// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The user's config file: changes to the soil's tables and to the fit.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "calibrate/fit_options.hpp"
#include "calibrate/soil_data.hpp"
#include "calibrate/strict_json.hpp"

namespace tilth {

/// Reads a "tilth.fit/1" file (docs/config.md) and applies it.
/// @throws ConfigError with every problem of the file
void apply_run_config(const std::filesystem::path& file, SoilData& soil, FitOptions& options);

/// Reads the object "fit" of such a file, if it is there; unknown keys are problems.
void read_fit_options(JsonObjectReader& config, FitOptions& options);

/// Nominal values of all parameters, ties not yet applied. @shape (num_parameters)
Eigen::VectorXd nominal_values(const SoilData& soil);

}  // namespace tilth
