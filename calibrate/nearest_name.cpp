// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/nearest_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace tilth {
namespace {

std::string folded(std::string_view word) {
  std::string result(word);
  for (char& letter : result) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    if (letter == '-' || letter == ' ') letter = '_';
  }
  return result;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::string from = folded(a);
  const std::string to = folded(b);
  std::vector<std::size_t> before_last(to.size() + 1), last(to.size() + 1), row(to.size() + 1);
  for (std::size_t j = 0; j <= to.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= from.size(); ++i) {
    before_last = last;
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t replace = last[j - 1] + (from[i - 1] == to[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[to.size()];
}

std::string nearest_name(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t longest_word = 200;  // a pasted paragraph gets no hint, and costs no time
  if (word.size() > longest_word) return "";
  const std::string* best = nullptr;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (best == nullptr || distance < best_distance) {
      best = &candidate;
      best_distance = distance;
    }
  }
  if (best == nullptr) return "";
  const std::size_t forgiven = std::max<std::size_t>(2, std::max(word.size(), best->size()) / 3);
  // A word whose letters all have to change is no relative of the candidate.
  return best_distance <= forgiven && best_distance < best->size() ? *best : "";
}

std::string unknown_name_sentence(std::string_view what, std::string_view word,
                                  std::span<const std::string> known) {
  std::string sentence = known.empty() ? fmt::format("unknown {} '{}': none is known", what, word)
                                       : fmt::format("unknown {} '{}': known are {}", what, word,
                                                     fmt::join(known, ", "));
  const std::string hint = nearest_name(word, known);
  if (!hint.empty()) sentence += fmt::format("; did you mean {}?", hint);
  return sentence;
}

}  // namespace tilth
