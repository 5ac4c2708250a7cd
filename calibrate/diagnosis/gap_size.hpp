// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// The size of the disagreement, and how much of it an added effect closed.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace tilth {

/// g = sqrt(max(0, mean_i(r_i^2 - V_ii))): root mean square disagreement beyond noise, in log
/// units.
/// @shape residual (p), variances (p); @return 0 for no statistics
double gap_size(const Eigen::VectorXd& residual, const Eigen::VectorXd& variances);

/// 1 - g_after / g_before; negative where the gap grew. Empty where there was no gap to close.
/// Fitted data are never evidence: use statistics that took no part in choice or fit.
std::optional<double> closure(double gap_before, double gap_after);

}  // namespace tilth
