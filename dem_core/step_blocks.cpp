// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "dem_core/step_blocks.hpp"

#include <algorithm>

#include "dem_core/records.hpp"

namespace tilth {
namespace {

using Index = std::int32_t;

/// First rows of the blocks and the end of the last.
std::vector<Index> cuts(const std::vector<Index>& row_begin, int num_blocks) {
  const auto num_rows = static_cast<Index>(row_begin.size() - 1);
  std::vector<Index> rows = {0};
  for (int b = 1; b < num_blocks; ++b) {
    const auto wanted = static_cast<Index>(static_cast<std::int64_t>(row_begin.back()) * b / num_blocks);
    const auto at = std::ranges::lower_bound(row_begin, wanted) - row_begin.begin();
    rows.push_back(std::clamp(static_cast<Index>(at), rows.back(), num_rows));
  }
  rows.push_back(num_rows);
  return rows;
}

}  // namespace

void cut_into_blocks(const State& state, Workspace& workspace) {
  workspace.blocks.clear();
  workspace.row_end.clear();
  workspace.cross_pair.clear();
  workspace.cross_row.clear();
  const std::vector<Index>& row_begin = state.contacts.row_begin;
  const auto num_rows = row_begin.empty() ? 0 : static_cast<int>(row_begin.size()) - 1;
  const int num_blocks = std::min(workspace.num_threads, num_rows / least_rows_per_block);
  if (num_blocks < 2 || !workspace.side_by_side) return;

  const std::vector<Index> rows = cuts(row_begin, num_blocks);
  const auto block_of = [&rows](Index i) {
    return static_cast<std::size_t>(std::ranges::upper_bound(rows, i) - rows.begin()) - 1;
  };
  workspace.blocks.resize(static_cast<std::size_t>(num_blocks));
  workspace.row_end.resize(static_cast<std::size_t>(num_rows));
  for (std::size_t b = 0; b < workspace.blocks.size(); ++b) {
    StepBlock& block = workspace.blocks[b];
    block.row_from = rows[b];
    block.row_to = rows[b + 1];
    block.cross_from = static_cast<Index>(workspace.cross_pair.size());
    for (Index i = block.row_from; i < block.row_to; ++i) {
      const auto row = static_cast<std::size_t>(i);
      Index p = row_begin[row];
      while (p < row_begin[row + 1] && workspace.pairs[static_cast<std::size_t>(p)].j < block.row_to) ++p;
      workspace.row_end[row] = p;
      for (; p < row_begin[row + 1]; ++p) {
        const auto k = static_cast<Index>(workspace.cross_pair.size());
        workspace.blocks[block_of(workspace.pairs[static_cast<std::size_t>(p)].j)].cross_in.push_back(k);
        workspace.cross_pair.push_back(p);
        workspace.cross_row.push_back(i);
      }
    }
    block.cross_to = static_cast<Index>(workspace.cross_pair.size());
  }
  const auto w = static_cast<std::size_t>(state.num_lanes);
  workspace.cross_force.assign(workspace.cross_pair.size() * 9 * w, 0.0);
  workspace.cross_acts.assign(workspace.cross_pair.size(), 0);
}

}  // namespace tilth
