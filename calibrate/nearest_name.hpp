// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// "Did you mean ...?": the nearest known name by edit distance.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tilth {

/// Damerau-Levenshtein distance (insert, delete, replace, swap of neighbours), letter case ignored,
/// "-", "_" and blanks taken as equal.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance to `word`; of equals, the first.
///
/// Empty when there is no candidate, or when the best one differs in more than a third of the
/// longer word's letters (at least 2 differences are always forgiven): a far-fetched hint is worse
/// than none.
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

/// "unknown <what> '<word>': known are a, b, c; did you mean b?" (the last part only with a hint).
std::string unknown_name_sentence(std::string_view what, std::string_view word,
                                  std::span<const std::string> known);

}  // namespace tilth
