// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What failed runs might have given, and how far that could move an estimate.
#pragma once

#include <vector>

#include "calibrate/sample_rows.hpp"

namespace tilth {

/// Most points an emulator of failed runs is made of: those of the ends of rows first.
inline constexpr std::size_t max_fill_points = 80;

/// The outputs with every missing value filled, in three ways: mean - 3 sd, mean, mean + 3 sd, all
/// missing values on the same side at once.
///
/// Mean and sd are an emulator's at the missing point (calibrate/emulator.hpp), sd at least its
/// root mean square leave-one-out error: sd grows with the distance from completed runs, and is
/// wide everywhere if the emulator is poor. 3 sd hold 95 % of any distribution with one peak: where
/// runs fail the emulator extrapolates, and 2 sd of a normal one would promise too much. An
/// estimate's bounds are the least and the largest of those on the completed runs and on these
/// three. They are scenarios, not a worst case: imputing the observed extremes one by one would
/// allow any index from 0 to 1 at 5 % missing runs. Repeats are left as they are. Empty if too few
/// runs completed for an emulator.
/// @source own construction, docs/theory/sensitivity.md; 3 sd: Vysochanskij & Petunin 1980
std::vector<RowOutputs> filled_outputs(const std::vector<SampleRow>& rows,
                                       const RowOutputs& outputs);

}  // namespace tilth
