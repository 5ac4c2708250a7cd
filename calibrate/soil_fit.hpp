// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// From the tables of a soil to the parameters and targets of a fit.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/fit_summary.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/soil_data.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// One Target per row in force, in the same order; `name` is label() (with the replicate, if any).
///
/// sigma_kind log becomes log_transform with the same sigma; the others become sigma_of(). A target
/// with several observation groups gets the one it stands for in num_independent_observations(), or
/// its first when they are used up, so that counting distinct groups gives the same number.
/// `weight` scales sigma by 1/sqrt(weight).
std::vector<Target> fit_targets(const SoilData& soil);

/// One Parameter per row, in the same order; tied ones are not estimated. Priors go to the
/// coordinate of the fit; a uniform prior narrows the bounds.
std::vector<Parameter> fit_parameters(const SoilData& soil);

/// The same values with every tied parameter recomputed from its master, chains included.
/// @pre values.size() == parameters.size(), ties without circles (load_soil refuses them)
Eigen::VectorXd with_ties(const std::vector<SoilParameter>& parameters, Eigen::VectorXd values);

/// Tied parameters are held during a fit and recomputed in every run: puts their values and expressions into the
/// summary. Does nothing where the summary has no parameters.
void show_ties(const std::vector<SoilParameter>& parameters, FitSummary& summary);

/// For the first line of the report: "measured targets: 0 of 4 (0 %); the rest: 4 derived; 2 held
/// out".
std::string provenance_sentence(const SoilData& soil);

}  // namespace tilth
