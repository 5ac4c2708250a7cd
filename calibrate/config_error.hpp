// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Bad input, said in full: every sentence of what is wrong, thrown once at the border.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tilth {

/// Thrown by the readers of user input; caught once, in the program, and shown with exit code 2.
///
/// `what()` is all sentences, one per line. Each sentence names the file, the line or JSON pointer,
/// what was found and what is allowed.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<std::string> sentences)
      : std::runtime_error(joined(sentences)), sentences_(std::move(sentences)) {}

  const std::vector<std::string>& sentences() const noexcept { return sentences_; }

 private:
  static std::string joined(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) {
      if (!text.empty()) text += '\n';
      text += sentence;
    }
    return text;
  }

  std::vector<std::string> sentences_;
};

}  // namespace tilth
