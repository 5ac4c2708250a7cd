// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// One step on several threads, with the bits of one thread.
//
// Rows of the pair list are cut into blocks of consecutive grains. A pair whose j lies in another block than
// its i is a cross pair: its forces go into a buffer first. Then every block adds, for each of its grains, the
// terms in the order of one thread: cross pairs with earlier blocks, its own pairs, cross pairs with later
// blocks (j ascends within a row). Sums of a grain are formed by one thread only, so nothing depends on timing.
#pragma once

#include "dem_core/state.hpp"

namespace tilth {

/// Cuts the pair list into workspace.num_threads blocks of about equal numbers of pairs; none if there is nothing
/// to run them side by side, or fewer than least_rows_per_block grains for each.
void cut_into_blocks(const State& state, Workspace& workspace);

/// Fewer are done sooner by one thread than two threads meet.
inline constexpr int least_rows_per_block = 250;

}  // namespace tilth
