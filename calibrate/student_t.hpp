// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Student's t distribution: intervals when sigma is estimated from the misfit itself.
#pragma once

namespace tilth {

/// P(|T| <= t) of Student's t with `freedom` degrees of freedom.
///
///   theta = atan(t / sqrt(freedom)); a finite sum of powers of cos(theta)
///
/// @pre t >= 0, freedom >= 1
/// @source Abramowitz & Stegun 1964, 26.7.3 (odd) and 26.7.4 (even)
/// @cost O(freedom)
double student_t_central_probability(double t, int freedom);

/// The t with P(|T| <= t) = probability, by bisection to rounding; 12.706 for 0.95 and 1 degree of
/// freedom, 1.960 for 0.95 and very many.
/// @pre 0 < probability < 1, freedom >= 1
double student_t_half_width(double probability, int freedom);

}  // namespace tilth
